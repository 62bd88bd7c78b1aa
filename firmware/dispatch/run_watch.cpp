#include "dispatch/run_watch.hpp"

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// Why a run clock that shows `clock` is not the one of `run`, or "".
std::string clock_of_another(const Run& run, double clock, double silence) {
  const double before = run.last->run_clock;
  if (clock < before - kClockJitter) {
    return icd::sentence("the run clock went back from ", before, " s to ", clock, " s");
  }
  // A clock at 0 belongs to a run that has not started: it may stay there for as long as it likes.
  if (before > 0 && silence > kShortSilence && clock - before < silence / 2) {
    return icd::sentence("after ", static_cast<std::int64_t>(silence),
                         " s without word the run clock had gone on by only ",
                         static_cast<std::int64_t>(clock - before), " s");
  }
  return "";
}

}  // namespace

std::string another_run(const Run& run, const icd::RunStatus& status, double silence) {
  if (!run.last) return "";
  const bool named = !status.current_team.empty() && !run.last->current_team.empty();
  if (named && status.current_team != run.last->current_team) {
    return icd::sentence("the team is ", icd::in_quotes(status.current_team), ", it was ",
                         icd::in_quotes(run.last->current_team));
  }
  return clock_of_another(run, status.run_clock, silence);
}

std::string another_run(const Run& run, const icd::ReportReply& reply, double silence) {
  if (!run.id.empty() && !reply.run.empty() && run.id != reply.run) {
    return icd::sentence("the Command Post calls it run ", icd::in_quotes(reply.run), ", it was ",
                         icd::in_quotes(run.id));
  }
  const bool has_clock = reply.run_clock > 0;
  return has_clock && run.last ? clock_of_another(run, reply.run_clock, silence) : "";
}

}  // namespace adit::dispatch
