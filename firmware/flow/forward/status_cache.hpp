#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "alarms/run_clock.hpp"
#include "icd/run_status.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::forward {

/// The last known status of the run: for the page, and with its age (RFC 9111 5.1) for clients while Adit
/// cannot ask.
class StatusCache {
 public:
  static constexpr std::chrono::seconds kFresh{1};                 // no request needed
  static constexpr std::chrono::seconds kOldest{15};               // better than no answer
  static constexpr std::chrono::seconds kOldestBehindReports{60};  // while reports go first

  /// `body`: `run` as JSON. `now`: stamp clock.
  void heard(std::string body, const icd::RunStatus& run, loop::Instant asked, icd::Stamp now);
  /// The status may have changed: still an answer, but not a fresh one.
  void no_longer_fresh() { fresh_ = false; }

  const std::optional<icd::RunStatus>& run() const { return run_; }
  std::optional<alarms::ShownClock> run_clock(icd::Stamp now) const { return run_clock_.at(now); }
  bool is_fresh(loop::Instant now) const;
  /// nullopt if older.
  std::optional<intake::Answer> answer(loop::Instant now, std::chrono::seconds oldest = kOldest) const;

 private:
  std::string body_;
  std::optional<icd::RunStatus> run_;
  alarms::RunClock run_clock_;
  std::optional<loop::Instant> asked_;
  bool fresh_ = false;
};

}  // namespace adit::forward
