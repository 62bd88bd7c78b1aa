#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "alarms/run_clock.hpp"
#include "dispatch/report_verdict.hpp"
#include "icd/header.hpp"
#include "icd/run_status.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::forward {

/// The last known status of the run: for the page as it came, and for clients while Adit cannot ask, with
/// the effect of the reports that were answered since, and with its age (RFC 9111 5.1).
class StatusCache {
 public:
  static constexpr std::chrono::seconds kFresh{1};    // no request needed
  static constexpr std::chrono::seconds kOldest{60};  // better than no answer

  /// `body`: `run` as JSON. `now`: stamp clock.
  void heard(std::string body, const icd::RunStatus& run, loop::Instant asked, icd::Stamp now);
  /// A report of the same run was answered: corrects the counts, and the clock if the two URIs may have the
  /// same one. `run_clock`: of the answer; 0: none.
  void add_report(const dispatch::Effect& effect, double run_clock, loop::Instant now);
  /// The status may have changed: still an answer, but not a fresh one.
  void no_longer_fresh() { fresh_ = false; }

  const std::optional<icd::RunStatus>& run() const { return run_; }
  std::optional<alarms::ShownClock> run_clock(icd::Stamp now) const { return run_clock_.at(now); }
  bool is_fresh(loop::Instant now) const;
  /// nullopt if older than kOldest.
  std::optional<intake::Answer> answer(loop::Instant now) const;

 private:
  std::optional<icd::RunStatus> run_;
  alarms::RunClock run_clock_;
  std::optional<loop::Instant> asked_;
  bool fresh_ = false;
  std::optional<icd::RunStatus> corrected_;
  std::string body_;  // `corrected_` in the Command Post's form
};

}  // namespace adit::forward
