#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dispatch/report.hpp"
#include "dispatch/report_book.hpp"
#include "dispatch/runs.hpp"
#include "dispatch/verdicts.hpp"

namespace adit::dispatch {

/// Effect of Adit's reports after the first one in doubt.
struct LaterReports {
  std::int64_t scored = 0;   // remaining reports that they used up
  std::int64_t points = 0;   // points that they gained, if certain
  std::int64_t unclear = 0;  // reports that may have gained one more
};

/// What the run's status shows about all reports in doubt.
enum class Finding : std::uint8_t {
  Recorded,
  NotRecorded,
  Silent,       // the status does not show it; a later one may
  Contradicts,  // Adit's own reports do not explain the counts, so the counts prove no report in this run
};

struct Evidence {
  Finding finding = Finding::Silent;
  std::string why;  // a sentence with the figures
  /// Points of each report, if certain.
  std::optional<std::int64_t> points_each;
};

/// Compares the present status with the status expected before the first of `doubts` reports was sent. A
/// recorded report lowers remaining_reports by one (ICD 5.1) and gains 0 or 1 point (ICD 5.2). `beside`:
/// other reports in doubt that may have changed the counts since.
Evidence weigh(const icd::RunStatus& before, std::int64_t doubts, std::int64_t beside,
               const LaterReports& since, const icd::RunStatus& now);

struct InquiryPolicy {
  /// From the loss to a request whose status may say "not recorded", because recording may be that late.
  std::chrono::milliseconds doubt_for{10000};
  std::int64_t asks = 3;  // successive statuses that must say "not recorded"
};

/// Decides from repeated statuses whether the reports in doubt were recorded.
class Inquiry {
 public:
  static constexpr std::int64_t kRecordedAsks = 2;  // successive statuses that must say "recorded"

  Inquiry(const InquiryPolicy& policy, Instant lost) : policy_(policy), lost_(lost) {}

  /// Adds the evidence of a status that was requested at `asked`. Returns the certain result, else Silent.
  Finding add_evidence(const Evidence& evidence, double run_clock, Instant asked, Instant now);
  void on_asked(Instant now) { asked_ = now; }
  void on_failed(Instant now) { in_vain_ = !is_pending(now); }
  /// No result for too long. Adit goes on asking, and the operator may decide.
  bool has_timed_out() const { return in_vain_; }

  Instant next_ask(Instant now) const;
  /// Other reports must wait. A second lost report would make the counts ambiguous.
  bool is_pending(Instant now) const;

 private:
  bool is_stalled(double run_clock, Instant now) const;

  InquiryPolicy policy_;
  Instant lost_;
  std::optional<Instant> asked_;
  Finding finding_ = Finding::Silent;
  std::int64_t agreeing_ = 0;
  std::optional<Instant> first_heard_, last_heard_;
  double first_clock_ = 0;
  bool in_vain_ = false;
};

/// The present run and its expected status: the last one, less the effect of Adit's own reports.
class RunAccount {
 public:
  static constexpr std::chrono::seconds kFresh{15};  // a status proves the run at least so long
  static constexpr double kWriteEvery = 150;         // seconds between writes for the run clock alone

  /// `book` outlives this.
  explicit RunAccount(ReportBook& book) : book_(book) {}

  /// The step that is subtracted from the run's silence.
  void on_clock_step(const ClockStep& step) { clock_step_ = step; }
  double seconds_between(double from, double until) const { return clock_step_.seconds_between(from, until); }
  /// A run that began after the last status of `earlier` may show the last clock of the present run.
  bool can_have_begun_since(const Run& earlier) const;
  /// `latest`: Runs::open().
  void open(std::vector<Run> all, std::int64_t latest, const std::string& post);

  const Run& run() const { return runs_.present(); }
  /// Last status of the present run, seconds since 1970; a lower bound after a restart. Reports that were
  /// answered later may belong to the next run.
  double status_at() const { return status_at_; }
  const Runs& runs() const { return runs_; }
  const Run& expected_run() const { return runs_.expected_run(); }
  /// True for reports of expected_run(), and for the one in flight, which a later run may record.
  bool is_of_run(const Report& report) const;
  /// Answered before the run was noticed, and its name is not known: it may be of the earlier run.
  bool is_unclaimed(const Report& report) const;
  /// Queued reports for the Command Post at `post`, oldest first.
  std::vector<std::int64_t> waiting_at(const std::string& post) const;
  std::vector<std::int64_t> waiting_here() const { return waiting_at(run().post); }
  /// `spacing`: between requests. A status proves the run until the next can arrive.
  void set_spacing(Instant::duration spacing);
  bool is_fresh(Instant now) const { return heard_ && now - *heard_ <= fresh_; }
  /// True if the Command Post answered recently, but without a usable status.
  bool is_dumb(Instant now) const { return !is_fresh(now) && dumb_at_ && now - *dumb_at_ <= fresh_; }
  /// The status expected now. nullopt: uncertain, or the counts prove no report.
  std::optional<icd::RunStatus> expected_status(Instant now) const;

  /// Why this status or answer is of another run. nullopt: it may be of the present run.
  std::optional<AnotherRun> another(const icd::RunStatus& status, Time time) const;
  std::optional<AnotherRun> another(const icd::ReportReply& reply, Time time) const;
  /// True if this status shows granted reports in the present run.
  bool is_grant(const icd::RunStatus& status, Time time) const;
  NameCheck check_name(const Run& before, const icd::RunStatus& status, Time time) const;
  /// Last earlier run of `team` at this Command Post, or null.
  const Run* find_by_team(const std::string& team) const;
  /// Last earlier run named `id` here, or null.
  const Run* find_by_name(const std::string& id) const;
  /// Latest run that the present one may still be and that `fits`, or null.
  const Run* find_possible_run(const std::function<bool(const Run&)>& fits) const;
  /// The signs that the present run is not `earlier`, which it may still be.
  Signs signs_against(const Run& earlier) const;

  /// Begins a run at the address in the settings. Writes it with `steps`. `may_be`: the run that it may still
  /// be if there are signs, or 0.
  void begin(const AnotherRun& another, std::int64_t may_be, const std::optional<icd::RunStatus>& status,
             std::span<const Report> steps, Time time);
  void set_next_run(std::int64_t number) { runs_.set_next_run(number); }
  /// Announces a new run at `post`, and writes it so that a restart finds it. Returns its number.
  std::int64_t announce(const std::string& why, const std::string& post, Time time);
  void adopt(std::int64_t number, std::span<const Report> steps, Time time);
  /// The present run and the runs between are the same run as `number`. `number` becomes the present run, and
  /// gets the latest status and clocks of all of them.
  void merge_into(std::int64_t number, std::span<const Report> steps, Time time);
  /// The present run is not `number`, for certain. It may still be a run between the two.
  void exclude(std::int64_t number) { book_.write(runs_.exclude(number)); }
  /// More signs that the present run is not the run that it may be.
  void add_signs(const Signs& signs);
  /// Names prove nothing in the present run. `why`: a sentence.
  void distrust_names(const std::string& why);
  /// Somebody granted reports: the next settle() takes the count.
  void grant() { is_granted_ = true; }

  void on_status(const icd::RunStatus& status, Time time);
  void on_answered(const icd::ReportReply& reply, Time time);
  void on_dumb(Instant now) { dumb_at_ = now; }
  /// A report came into doubt: the expected status is uncertain.
  void forget_expected() { known_.reset(); }
  /// The same until `until`, because a report that the operator decided may still be recorded.
  void forget_expected(Instant until);
  /// Compares a status with the expected one, and starts from it. Call it only while each doubt that the
  /// counts may decide is counted. `open`: other doubts, each of which may explain a report and a point.
  void settle(const icd::RunStatus& status, std::int64_t open, Time time);
  /// The clock was seen to run, but not by the last status: perhaps a stop, in which counts show no report.
  bool is_stopped() const { return is_stopped_; }
  /// The counts prove no report until the next run.
  void distrust(const std::string& why, double stamp);

 private:
  struct LastStatus {
    icd::RunStatus status;
    Instant heard;
    LaterReports since;
  };
  void forget_counts();
  void write_down(double stamp);
  /// Seconds, at least, without word of `run`.
  double silence_of(const Run& run, Time time) const;
  Silence silence(Time time) const;
  bool is_clock_stopped(const icd::RunStatus& status, Time time) const;

  ReportBook& book_;
  Runs runs_;
  std::string post_;
  ClockStep clock_step_;
  double written_ = 0;  // Run::heard on disk
  double status_at_ = 0;
  Instant::duration fresh_ = kFresh;
  std::optional<Instant> heard_;  // the last status or answer of the run
  std::optional<Instant> dumb_at_;
  std::optional<Instant> clock_at_;     // last clock of the run in this process
  std::optional<Instant> status_came_;  // last status in this process, of a run that may be the present one
  std::optional<LastStatus> known_;
  std::optional<Instant> uncertain_until_;
  bool odd_ = false;        // last status not as expected
  bool has_moved_ = false;  // a count has changed
  bool is_stopped_ = true;
  bool is_granted_ = false;  // reports were granted since the last settle()
  bool unscored_ = false;    // by the last answer, reports are not scored
};

}  // namespace adit::dispatch
