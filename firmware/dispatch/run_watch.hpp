#pragma once

#include <optional>
#include <string>

#include "dispatch/run.hpp"
#include "icd/run_status.hpp"

namespace adit::dispatch {

/// How much a run clock may seem to run backward within one run.
inline constexpr double kClockJitter = 1.0;  // seconds
/// Within a shorter silence than this no run ends and another overtakes its clock unnoticed.
inline constexpr double kShortSilence = 30.0;  // seconds
/// By so much a box's clock may begin ahead after a restart of the machine.
inline constexpr double kClockAhead = 30.0;  // seconds

/// Another run than the one that was known.
struct AnotherRun {
  std::string why;
  /// Its name, its team or its count of reports says so; else only its clock, so that it may be the same yet.
  bool certain = true;
};

/// What a status, heard `silence` seconds after the last word of `run`, shows: another team, more reports
/// left than before, or a clock that was seen to run in this run's statuses and now ran backward, or after a
/// long silence does not fit the time that went by. A clock that stands, or another URI's, shows nothing.
/// Nothing: it may be one of `run`.
std::optional<AnotherRun> another_run(const Run& run, const icd::RunStatus& status, double silence);

/// The same of an answer to a report, by its `run` (ICD 5.2); where that is not known, by the clock of the
/// answers.
std::optional<AnotherRun> another_run(const Run& run, const icd::ReportReply& reply, double silence);

/// The run's clock was seen to run, so that a status of another run would show by its clock.
bool tells_of_another(const Run& run);

/// The map that a Command Post has after a change of the run.
enum class NextMap {
  MayBeTheSame,  // the old map, or an empty one
  Empty,         // except for maps that arrived after the last status of the old run
  Earlier,       // the map of an earlier run
};

/// `now` has become the present run in place of `before`. More reports left are not enough for another map,
/// because somebody may have granted one.
NextMap next_map(const Run& before, const Run& now);

/// Both are teams, and different ones.
bool are_other_teams(const std::string& one, const std::string& other);

}  // namespace adit::dispatch
