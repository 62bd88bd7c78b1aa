#pragma once

#include <string>
#include <utility>
#include <vector>

#include "api/network.hpp"
#include "api/self_test.hpp"

namespace adit::api {

/// Has the addresses that a test sets, and records requests.
struct FakeNetwork final : Network {
  NetworkView state() const override { return view; }
  network::Findings check(const network::Numbers&, const std::string& asker) const override {
    askers.push_back(asker);
    return findings;
  }
  icd::Checked<void> change(const network::Numbers& numbers) override {
    wanted.push_back(numbers);
    return outcome;
  }
  icd::Checked<void> confirm(const std::string& local) override {
    confirmed.push_back(local);
    return outcome;
  }
  icd::Checked<void> revert() override {
    ++reverted;
    return outcome;
  }

  NetworkView view;
  network::Findings findings;
  icd::Checked<void> outcome;
  mutable std::vector<std::string> askers;
  std::vector<network::Numbers> wanted;
  std::vector<std::string> confirmed;
  int reverted = 0;
};

struct FakeTest final : SelfTest {
  TestView state() const override { return view; }
  icd::Checked<void> begin_test(const Candidate& candidate) override {
    if (!outcome) return outcome;
    if (std::exchange(view.running, true))
      return std::unexpected(icd::Refusal{icd::Status::Conflict, "a test is running"});
    tried = candidate;
    return {};
  }
  TestView view;
  Candidate tried;
  icd::Checked<void> outcome;
};

}  // namespace adit::api
