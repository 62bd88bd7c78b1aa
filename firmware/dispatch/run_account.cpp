#include "dispatch/run_account.hpp"

#include "dispatch/run_watch.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {

void RunAccount::open(std::optional<Run> run, std::int64_t latest, const std::string& post) {
  if (run) run_ = *std::move(run);
  if (run_.number < latest) run_ = {.number = latest, .last = std::nullopt};
  if (run_.post.empty()) run_.post = post;
  post_ = post;
  written_ = run_.heard;
}

std::optional<icd::RunStatus> RunAccount::expected(Instant now) const {
  if (!known_ || odd_ || unscored_ || !run_.unreliable.empty()) return std::nullopt;
  icd::RunStatus status = known_->status;
  status.remaining_reports -= known_->since.scored;
  status.score += known_->since.points;
  if (status.run_clock > 0) status.run_clock += std::chrono::duration<double>(now - known_->heard).count();
  return status;
}

std::string RunAccount::another(const icd::RunStatus& status, Time time) const {
  return another_run(run_, status, silence(time));
}

std::string RunAccount::another(const icd::ReportReply& reply, Time time) const {
  return another_run(run_, reply, silence(time));
}

/// In seconds. Over a restart by the box's clock, which may be set in between; else not, so that a clock that
/// is set makes no new run.
double RunAccount::silence(Time time) const {
  return clock_at_ ? std::chrono::duration<double>(time.now - *clock_at_).count() : time.stamp - run_.heard;
}

void RunAccount::begin(const std::string& why, const std::optional<icd::RunStatus>& status,
                       std::span<const Report> steps, Time time) {
  run_ = {.number = run_.number + 1,
          .began = time.stamp,
          .why = why,
          .last = status,
          .heard = time.stamp,
          .post = post_};
  clock_at_ = time.now;
  known_.reset();
  odd_ = unscored_ = false;
  book_.change(steps, run_);
  written_ = time.stamp;
}

void RunAccount::heard(const icd::RunStatus& status, Time time) {
  heard_ = clock_at_ = time.now;
  const bool first = !run_.last;
  run_.last = status;
  run_.heard = time.stamp;
  if (first || time.stamp - written_ >= kWriteEvery || time.stamp < written_) write_down(time.stamp);
}

void RunAccount::answered(const icd::ReportReply& reply, Time time) {
  const Effect effect = effect_of(reply);
  heard_ = time.now;
  unscored_ = !effect.scored;
  if (reply.run_clock > 0 && run_.last) {
    run_.last->run_clock = reply.run_clock;
    run_.heard = time.stamp;
    clock_at_ = time.now;
  }
  if (run_.id.empty() && !reply.run.empty()) {
    run_.id = reply.run;
    write_down(time.stamp);
  }
  if (!known_ || !effect.scored) return;
  ++known_->since.scored;
  known_->since.points += effect.points;
}

void RunAccount::lose(Instant until) {
  known_.reset();
  uncertain_until_ = until;
}

void RunAccount::settle(const icd::RunStatus& status, Time time) {
  if (uncertain_until_ && time.now < *uncertain_until_) return;
  // Before the start of a run its counts may be set to anything.
  if (known_ && known_->status.run_clock > 0) {
    const std::int64_t remaining = known_->status.remaining_reports - known_->since.scored;
    const std::int64_t score = known_->status.score + known_->since.points;
    const bool fits = status.remaining_reports == remaining && status.score == score;
    if (!fits && !odd_) {  // it may be a count that lags behind: the next status decides
      odd_ = true;
      return;
    }
    if (!fits) {
      distrust(icd::sentence("the Command Post counts ", status.remaining_reports, " reports left and score ",
                             status.score, ", Adit's own reports make it ", remaining, " and ", score,
                             ": somebody else reports with this token"),
               time.stamp);
    }
  }
  odd_ = false;
  known_ = {.status = status, .heard = time.now, .since = {}};
}

void RunAccount::distrust(const std::string& why, double stamp) {
  if (!run_.unreliable.empty()) return;
  run_.unreliable = why;
  write_down(stamp);
}

void RunAccount::write_down(double stamp) {
  book_.write(run_);
  written_ = stamp;
}

}  // namespace adit::dispatch
