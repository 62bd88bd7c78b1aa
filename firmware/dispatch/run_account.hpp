#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "dispatch/evidence.hpp"
#include "dispatch/report.hpp"
#include "dispatch/report_book.hpp"
#include "dispatch/report_verdict.hpp"

namespace adit::dispatch {

/// The present run, and what /api/status would answer now: the last status, less what Adit's own reports
/// have changed since.
class RunAccount {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kFresh{15};  // how long a status vouches for the run
  static constexpr double kWriteEvery = 30;          // seconds between writes of the run clock alone

  /// `book` outlives this.
  explicit RunAccount(ReportBook& book) : book_(book) {}

  /// `latest`: the highest run that a report belongs to; it may have been written down before its run was.
  void open(std::optional<Run> run, std::int64_t latest, const std::string& post);

  const Run& run() const { return run_; }
  /// The run was heard of less than kFresh ago.
  bool is_fresh(Instant now) const { return heard_ && now - *heard_ <= kFresh; }
  /// The Command Post was asked less than kFresh ago, and answered nothing that helps.
  bool is_dumb(Instant now) const { return !is_fresh(now) && dumb_at_ && now - *dumb_at_ <= kFresh; }
  /// What /api/status would answer; nothing: it is not known for certain, or proves nothing.
  std::optional<icd::RunStatus> expected(Instant now) const;

  /// Why this status is one of another run, or "".
  std::string another(const icd::RunStatus& status, Time time) const;
  std::string another(const icd::ReportReply& reply, Time time) const;
  /// Another run begins, with this status if one was heard; what that does to the reports is written down
  /// with it.
  void begin(const std::string& why, const std::optional<icd::RunStatus>& status,
             std::span<const Report> steps, Time time);

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
  void write_down(double stamp);
  double silence(Time time) const;

  ReportBook& book_;
  Run run_;
  std::string post_;
  double written_ = 0;            // Run::heard as it is on disk
  std::optional<Instant> heard_;  // the last word of the run, by a status or an answer
  std::optional<Instant> dumb_at_;
  std::optional<Instant> clock_at_;  // when run_.last's clock was heard, if in this program's life
  std::optional<Known> known_;
  std::optional<Instant> uncertain_until_;
  bool odd_ = false;       // the last status was not as expected
  bool unscored_ = false;  // the last answer says that reports are not being scored
};

}  // namespace adit::dispatch
