#pragma once

#include <optional>
#include <string>

#include "dispatch/run.hpp"
#include "icd/run_status.hpp"

namespace adit::dispatch {

/// Tolerance of a run clock that goes back.
inline constexpr double kClockJitter = 1.0;  // seconds
/// A new run needs a longer silence to overtake the old run's clock unnoticed.
inline constexpr double kShortSilence = 30.0;  // seconds
/// How far the stamp clock may start ahead after a boot.
inline constexpr double kClockAhead = 170.0;  // seconds

struct AnotherRun {
  std::string why;
  /// By its name, its team or its count of reports. False: by its clock alone, so it may still be the same
  /// run.
  bool certain = true;
};

/// Whether a status, `silence` seconds after the last one of `run`, shows another run: another team, more
/// remaining reports, or a clock that ran and then went back or fell behind in a long silence. nullopt: it
/// may be of `run`.
std::optional<AnotherRun> another_run(const Run& run, const icd::RunStatus& status, double silence);

/// The same by an answer's `run` (ICD 5.2), or if that is missing, by its clock.
std::optional<AnotherRun> another_run(const Run& run, const icd::ReportReply& reply, double silence);

/// True if the clock of the statuses was seen to run, so that it would show another run.
bool tells_of_another(const Run& run);

/// The Command Post's map after a change of run.
enum class NextMap {
  MayBeTheSame,  // the old map, or an empty one
  Empty,         // except for maps that arrived after the last status of the old run
  Earlier,       // the map of an earlier run
};

/// `now` has replaced `before`. More remaining reports are not enough, because somebody may have granted one.
NextMap next_map(const Run& before, const Run& now);

bool are_other_teams(const std::string& one, const std::string& other);

}  // namespace adit::dispatch
