#pragma once

#include <vector>

#include "api/clock.hpp"

namespace adit::api {

/// A clock whose state a test sets. Records the times that it is set to.
struct FakeClock final : Clock {
  ClockView state() const override { return view; }
  icd::Checked<void> set_clock(double time) override {
    if (outcome) set.push_back(time);
    if (outcome) view.now = time;
    return outcome;
  }

  ClockView view;
  icd::Checked<void> outcome;
  std::vector<double> set;
};

}  // namespace adit::api
