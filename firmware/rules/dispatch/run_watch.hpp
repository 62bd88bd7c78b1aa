#pragma once

#include <cstdint>
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
  Signs signs;  // none: certain, because the team is another one
};

/// Seconds without word of a run.
struct Silence {
  double at_least = 0;                                // since its last clock
  std::optional<double> since_status = std::nullopt;  // since its last status; nullopt: before this process
};

/// Whether a status, after that silence, shows another run than `run`: another team, more remaining reports,
/// a lower score, or a clock that ran and then went back or fell behind in a long silence. nullopt: it may be
/// of `run`. More reports or a lower score alone are no sign while the clock goes on (goes_on()).
std::optional<AnotherRun> another_run(const Run& run, const icd::RunStatus& status, const Silence& silence);

/// The same by an answer's `run` (ICD 5.2), or if that is missing, by its clock.
std::optional<AnotherRun> another_run(const Run& run, const icd::ReportReply& reply, const Silence& silence);

/// True if the clock of the statuses advanced as time passed, to a value that no run can show that began
/// since the last status.
bool goes_on(const Run& run, const icd::RunStatus& status, const Silence& silence);

/// True if the status shows more reports left in a run that certainly goes on: somebody granted them.
bool is_grant(const Run& run, const icd::RunStatus& status, const Silence& silence);

/// What the first status after another name shows of that name. `before`: the earlier run, with a last
/// status.
enum class NameCheck : std::uint8_t {
  Confirmed,     // a sign of another run agrees, or a run that began since may show this status
  Contradicted,  // the counts and the clock of `before` go on
  Unknown,
};
NameCheck check_name(const Run& before, const icd::RunStatus& status, const Silence& silence);

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
