#include "dispatch/run_watch.hpp"

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

std::optional<AnotherRun> clock_of_another(const std::optional<Clock>& clock, double shows, double silence) {
  if (!clock || !clock->runs) return std::nullopt;
  const double before = clock->shows;
  if (shows < before - kClockJitter) {
    return AnotherRun{icd::sentence("the run clock went back from ", before, " s to ", shows, " s"), false};
  }
  // At 0 the run has not started, and the clock may stand.
  if (before > 0 && silence > kShortSilence && shows - before < silence / 2) {
    return AnotherRun{
        icd::sentence("after ", static_cast<std::int64_t>(silence), " s of silence the run clock was only ",
                      static_cast<std::int64_t>(shows - before), " s ahead"),
        false};
  }
  return std::nullopt;
}

/// Before a run starts, the Command Post may set its counts to any value.
bool has_started(const Run& run) {
  return run.last->run_clock > 0 || (run.answer_clock && run.answer_clock->shows > 0);
}

/// Without a status of both, the operator has decided.
bool are_certainly_different(const Run& before, const Run& now) {
  const bool are_heard = before.last && now.last;
  if (are_heard && are_other_teams(before.last->current_team, now.last->current_team)) return true;
  if (!before.id.empty() && !now.id.empty()) return before.id != now.id;
  if (now.may_be != 0) return false;
  return !are_heard || now.last->run_clock < before.last->run_clock - kClockJitter;
}

}  // namespace

bool are_other_teams(const std::string& one, const std::string& other) {
  return !one.empty() && !other.empty() && one != other;
}

std::optional<AnotherRun> another_run(const Run& run, const icd::RunStatus& status, double silence) {
  if (!run.last) return std::nullopt;
  if (are_other_teams(status.current_team, run.last->current_team)) {
    return AnotherRun{icd::sentence("the team is ", icd::in_quotes(status.current_team), ", it was ",
                                    icd::in_quotes(run.last->current_team))};
  }
  if (has_started(run) && status.remaining_reports > run.last->remaining_reports) {
    return AnotherRun{icd::sentence("the reports left went up from ", run.last->remaining_reports, " to ",
                                    status.remaining_reports)};
  }
  return clock_of_another(run.status_clock, status.run_clock, silence);
}

std::optional<AnotherRun> another_run(const Run& run, const icd::ReportReply& reply, double silence) {
  if (!run.id.empty() && !reply.run.empty()) {
    if (run.id == reply.run) return std::nullopt;
    return AnotherRun{icd::sentence("the Command Post calls it run ", icd::in_quotes(reply.run), ", it was ",
                                    icd::in_quotes(run.id))};
  }
  if (reply.run_clock <= 0) return std::nullopt;  // no clock
  return clock_of_another(run.answer_clock, reply.run_clock, silence);
}

bool tells_of_another(const Run& run) {
  return run.status_clock && run.status_clock->runs;
}

NextMap next_map(const Run& before, const Run& now) {
  if (!are_certainly_different(before, now)) return NextMap::MayBeTheSame;
  return now.began >= before.heard ? NextMap::Empty : NextMap::Earlier;
}

}  // namespace adit::dispatch
