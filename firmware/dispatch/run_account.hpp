#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "dispatch/evidence.hpp"
#include "dispatch/report.hpp"
#include "dispatch/report_book.hpp"
#include "dispatch/report_verdict.hpp"
#include "dispatch/run_watch.hpp"
#include "dispatch/runs.hpp"

namespace adit::dispatch {

/// The present run, and what /api/status would answer now: the last status, less what Adit's own reports
/// have changed since.
class RunAccount {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kFresh{15};  // how long a status vouches for the run, at least
  static constexpr double kWriteEvery = 30;          // seconds between writes of the run clock alone

  /// `book` outlives this.
  explicit RunAccount(ReportBook& book) : book_(book) {}

  /// Over which the run's silence is counted.
  void leapt(const Leap& leap) { leap_ = leap; }
  double between(double from, double until) const { return leap_.between(from, until); }
  /// `latest`: the highest run that a report belongs to; it may have been written down before its run was.
  void open(std::vector<Run> all, std::int64_t latest, const std::string& post);

  const Run& run() const { return runs_.present(); }
  /// When the present run's last status was heard: what was answered since may be of the next one. Seconds
  /// since 1970; not later than it was, where that was before this program's life.
  double status_at() const { return status_at_; }
  const Runs& runs() const { return runs_; }
  /// Requests are so far apart: a status vouches for the run until the next one may go.
  void paced(Instant::duration spacing);
  /// A status still vouches for the run.
  bool is_fresh(Instant now) const { return heard_ && now - *heard_ <= fresh_; }
  /// The Command Post was asked as short a time ago, and answered nothing that helps.
  bool is_dumb(Instant now) const { return !is_fresh(now) && dumb_at_ && now - *dumb_at_ <= fresh_; }
  /// What /api/status would answer; nothing: it is not known for certain, or proves nothing.
  std::optional<icd::RunStatus> expected(Instant now) const;

  /// Why this is one of another run; nothing: it is not.
  std::optional<AnotherRun> another(const icd::RunStatus& status, Time time) const;
  std::optional<AnotherRun> another(const icd::ReportReply& reply, Time time) const;
  /// A run of that status' team here, from before another team's; nothing: none was seen.
  const Run* of_team(const std::string& team) const;
  /// A run of that name here, from before one of another name.
  const Run* of_name(const std::string& id) const;
  /// Of the runs that the present one may be, the latest that has a name.
  const Run* named_before() const;

  /// Another run begins, at the place that the settings name, with this status if one was heard; what that
  /// does to the reports is written down with it. `may_be`: the run that it may be still; 0: none.
  void begin(const std::string& why, std::int64_t may_be, const std::optional<icd::RunStatus>& status,
             std::span<const Report> steps, Time time);
  /// Another run, at `post`, will be the present one: a restart finds it. Gives its number.
  std::int64_t announce(const std::string& why, const std::string& post, Time time);
  /// An earlier one is the present one again.
  void take_up(std::int64_t number, std::span<const Report> steps, Time time);
  /// The present run is `number`, which it may be, and so are the runs between them. `number` becomes the
  /// present run, with what is known of all of them.
  void merge_into(std::int64_t number, std::span<const Report> steps, Time time);
  /// The present run is not `number`, for certain. It may still be a run between the two.
  void is_not(std::int64_t number);

  /// A status of this run.
  void heard(const icd::RunStatus& status, Time time);
  /// An answer to a report, of this run.
  void answered(const icd::ReportReply& reply, Time time);
  void dumb(Instant now) { dumb_at_ = now; }
  /// A report came into doubt: what follows from the last status is not certain.
  void lose() { known_.reset(); }
  /// The same, and it stays so until `until`: what is in doubt no longer, because the operator judged it, may
  /// still be recorded.
  void lose(Instant until);
  /// Compares a status with what was expected, when nothing is in doubt, and starts from it.
  void settle(const icd::RunStatus& status, Time time);
  /// From now on, and until the next run, the count of reports proves nothing.
  void distrust(const std::string& why, double stamp);

 private:
  struct Known {
    icd::RunStatus status;
    Instant heard;
    SentSince since;
  };
  void forget_counts();
  void write_down(double stamp);
  double silence(Time time) const;

  ReportBook& book_;
  Runs runs_;
  std::string post_;
  Leap leap_;
  double written_ = 0;  // Run::heard as it is on disk
  double status_at_ = 0;
  Instant::duration fresh_ = kFresh;
  std::optional<Instant> heard_;  // the last word of the run, by a status or an answer
  std::optional<Instant> dumb_at_;
  std::optional<Instant> clock_at_;  // when one of the run's clocks was heard, if in this program's life
  std::optional<Known> known_;
  std::optional<Instant> uncertain_until_;
  bool odd_ = false;        // the last status was not as expected
  bool has_moved_ = false;  // a count changed from one status to the next
  bool unscored_ = false;   // the last answer says that reports are not being scored
};

}  // namespace adit::dispatch
