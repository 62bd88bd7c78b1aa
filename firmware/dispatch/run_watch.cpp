#include "dispatch/run_watch.hpp"

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

std::string backward(double before, double now) {
  if (now >= before - kClockJitter) return "";
  return icd::sentence("the run clock went back from ", before, " s to ", now, " s");
}

}  // namespace

std::string another_run(const Run& run, const icd::RunStatus& status, double stamp) {
  if (!run.last) return "";
  if (status.current_team != run.last->current_team) {
    return icd::sentence("the team is ", icd::in_quotes(status.current_team), ", it was ",
                         icd::in_quotes(run.last->current_team));
  }
  if (std::string why = backward(run.last->run_clock, status.run_clock); !why.empty()) return why;
  const double advanced = status.run_clock - run.last->run_clock;
  const double silence = stamp - run.heard;
  // A clock at 0 belongs to a run that has not started: it may stay there for as long as it likes.
  if (run.last->run_clock > 0 && silence > kShortSilence && advanced < silence / 2) {
    return icd::sentence("after ", static_cast<std::int64_t>(silence),
                         " s without word the run clock had gone on by only ",
                         static_cast<std::int64_t>(advanced), " s");
  }
  return "";
}

std::string another_run(const Run& run, const icd::ReportReply& reply) {
  if (!run.id.empty() && !reply.run.empty() && run.id != reply.run) {
    return icd::sentence("the Command Post calls it run ", icd::in_quotes(reply.run), ", it was ",
                         icd::in_quotes(run.id));
  }
  const bool has_clock = reply.run_clock > 0;
  return has_clock && run.last ? backward(run.last->run_clock, reply.run_clock) : "";
}

}  // namespace adit::dispatch
