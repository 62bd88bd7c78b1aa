#pragma once

#include <string>

#include "alarms/facts.hpp"

namespace adit::alarms {

/// Answers "is my map arriving?" for all robots.
struct Verdict {
  Level level = Level::Quiet;
  std::string what = {}, why = {};
  static const codec::Row kRow;
  friend bool operator==(const Verdict&, const Verdict&) = default;
};

Verdict verdict_of(const Facts& facts);

}  // namespace adit::alarms
