#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "dispatch/report_life.hpp"
#include "icd/artifact_report.hpp"
#include "icd/run_status.hpp"

namespace adit::dispatch {

/// The time by both clocks that the rules need: one for waiting, one for writing down.
struct Time {
  std::chrono::steady_clock::time_point now;
  double stamp = 0;  // seconds since 1970
};

/// With a restart of the machine the clock for stamps may go ahead by more than the time that went by: the
/// time of day was set, and the machine begins with that.
struct Leap {
  double to = 0;  // stamps from here on are later by `by`; seconds since 1970
  double by = 0;  // seconds

  /// The seconds that went by from one stamp to a later one.
  double between(double from, double until) const {
    return until - from - (from < to && to <= until ? by : 0);
  }
  friend bool operator==(const Leap&, const Leap&) = default;
};

/// One artifact report and all that is known of it: what the ledger holds.
struct Report {
  std::int64_t number = 0;  // Adit's own, from 1, never used twice
  icd::ArtifactReport report = {};
  std::string sender = "";  // address of who posted it, "operator", or kLost
  double received = 0;      // seconds since 1970
  double changed = 0;
  ReportState state = ReportState::Queued;
  std::string note = "";  // a sentence for the operator: why it is where it is

  std::int64_t run = 0;      // Run::number of the run that it belongs to
  bool asked = false;        // sent on purpose: not held as a repeat, a near duplicate or one of an old run
  std::int64_t same_as = 0;  // the earlier report that it turned out to be; 0: none
  std::int64_t tries = 0;    // how often it was sent and no answer came
  std::int64_t sending = 0;  // its place among all sendings, the last time; 0: never sent
  double sent = 0;           // when, the last time; seconds since 1970
  /// What /api/status would have answered just before it was sent; nothing: that was not known for certain.
  std::optional<icd::RunStatus> before = std::nullopt;

  int status = 0;                 // of its answer; 0: none yet
  std::string content_type = "";  // of that answer
  std::string answer = "";        // its body, byte for byte
  bool reconciled = false;        // the answer is Adit's, found out from the run's status

  /// It stands for reports that damage took from the ledger: all that is known is that they may have been
  /// sent. Its note says which they are.
  bool is_lost() const { return sender == kLost; }
  static constexpr std::string_view kLost = "lost";
  friend bool operator==(const Report&, const Report&) = default;
};

}  // namespace adit::dispatch
