#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dispatch/report.hpp"
#include "dispatch/run_account.hpp"
#include "dispatch/runs.hpp"

namespace adit::dispatch {

/// Reports that need the operator's release.
enum class Review : std::uint8_t { Off, Duplicates, All };

struct ReportRules {
  std::chrono::milliseconds answer_within{20000};  // then a client gets the state instead of the answer
  Review review = Review::Off;
  double near_metres = 5;  // same type and so near: a near duplicate
  InquiryPolicy policy;
  std::size_t most_waiting = 1000;
  std::chrono::seconds undo{0};  // how long a report waits for an undo, if PostedReport::can_be_undone
};

/// Why the operator must release a report. Empty: no reason.
struct Hold {
  std::string why = "";
  std::int64_t same_as = 0;  // the report that it may repeat: held until the run is certain
  bool for_undo = false;     // held for ReportRules::undo only
};

/// Decides which report repeats another one, and which one waits for the operator or for an undo.
class ReportReview {
 public:
  /// All outlive this.
  ReportReview(const ReportRules& rules, const ReportBook& book, const RunAccount& account)
      : rules_(rules), book_(book), account_(account) {}

  /// The same reports of RunAccount::expected_run(), oldest first.
  std::vector<const Report*> same_in_run(const icd::ArtifactReport& report) const;
  /// The report that this one would repeat in that run, or null.
  const Report* earlier(const Report& report) const;
  /// Another same report of that run, queued or sent, or null.
  const Report* find_duplicate(const Report& report) const;
  /// The same report of that run, sent after this one and answered, or null.
  const Report* answered_later(const Report& report) const;
  /// The same report, sent to another Command Post, if this one has not answered yet. Otherwise null.
  const Report* other_command_post_twin(const Report& report) const;
  Hold reason_to_hold(const Report& report) const;
  /// Reports in doubt that the present run may have got before the ledger lost them. New reports are held.
  std::vector<const Report*> lost_reports() const;

  /// The run is unknown: compare the report before it is sent.
  void compare_later(std::int64_t number) { unchecked_.insert(number); }
  bool is_unchecked(std::int64_t number) const { return unchecked_.contains(number); }
  void on_compared(std::int64_t number) { unchecked_.erase(number); }

  /// The reason for a report that waits for an undo. Empty if the rules give no time for it.
  Hold hold_for_undo() const;
  void await_undo(std::int64_t number, Time time);
  bool awaits_undo(std::int64_t number) const { return undo_.contains(number); }
  void end_undo(std::int64_t number);
  std::optional<double> sends_at(std::int64_t number) const;
  std::optional<Instant> next_undo() const;
  /// Reports whose time is over. Their next time is a second later, in case that a write fails.
  std::vector<std::int64_t> late_undos(Instant now);
  /// Ends all waits, and returns their reports. The operator decides.
  std::vector<std::int64_t> end_undos();
  /// The operator decides: ends the wait and the comparison.
  void on_decided(std::int64_t number);

 private:
  /// The time for an undo of a held report. It is in no file, so that a restart leaves the report held.
  struct Undo {
    Instant until;
    double stamp;  // the same, in seconds since 1970
  };

  Hold repeat_hold(const Report& report) const;
  const Report* sent_elsewhere(const Report& report, const std::function<bool(const Run&)>& counts) const;

  const ReportRules& rules_;
  const ReportBook& book_;
  const RunAccount& account_;
  std::set<std::int64_t> unchecked_;  // not compared yet, because the run was unknown
  std::map<std::int64_t, Undo> undo_;
};

/// The body of Adit's 201 for a report whose answer was lost and whose record the run's status shows: the
/// fields of ICD 5.2, null if uncertain, and `adit` with the figures.
std::string reconciled_answer(const Report& report, const Run& run, std::optional<std::int64_t> points,
                              const std::string& figures);

/// Decides reports in doubt: asks for the run's status until an Inquiry or the operator decides.
///
/// A doubt whose earlier counts are certain is decided with those that follow before it is counted: a group.
/// Other doubts are the operator's. A doubt is counted by the first status requested `doubt_for` after its
/// loss, unless the clock stands in a stop. Until then it may explain a change of the counts.
class Doubts {
 public:
  using Reports = std::vector<const Report*>;

  static constexpr std::int64_t kMostTries = 5;  // losses until a report is held

  /// All outlive this.
  Doubts(const InquiryPolicy& policy, ReportBook& book, RunAccount& account, const ReportReview& review)
      : policy_(policy), book_(book), account_(account), review_(review) {}

  std::chrono::milliseconds doubt_for() const { return policy_.doubt_for; }
  /// In doubt in the present run, in the order of sending.
  Reports all() const { return book_.doubts(account_.run().number); }
  /// Call at a start, before begin(). Reports of a replaced box may have come into doubt together.
  void open();
  /// Starts again, for runs() doubts. Call it if one is added or leaves, or if runs were one.
  void begin(Instant now);
  /// begin() with another run. Notes its state in `before`, the doubts of the run before.
  void begin_run(const Reports& before, Time time) {
    begin(time.now);
    explain(before, "", time);
  }
  /// Report `number` came into doubt.
  void on_lost(std::int64_t number, Instant now);
  /// A status requested at `asked`. Returns the steps that it decides: of all reports of a group, or none.
  std::vector<ReportBook::Step> decide_by_status(const icd::RunStatus& status, Instant asked, Time time);
  /// After the steps of decide_by_status(): the doubts that this status counts.
  void count(Instant asked, Time time);
  void on_failed(Time time);

  /// True if a report that is sent now and lost would be decided with an earlier one.
  bool has_open_group() const;
  /// Of the operator's doubts, those that may still explain a change of the counts.
  std::int64_t open_count() const;

  /// Notes the state of the inquiry in `doubts`. `seen`: what the last status showed.
  void explain(const Reports& doubts, const std::string& seen, Time time);
  /// Call before the operator's decision about `decided` is written: forgets other doubts' expected counts,
  /// which no longer show the result, so that a power cut leaves no wrong evidence. False: the write failed.
  bool blur(std::int64_t decided, Time time);
  /// After the operator's decision.
  void ask_for_others(Time time);
  /// The counts no longer show what became of runs(): the operator decides.
  void leave_to_operator(const std::string& why, Time time);

  /// Reports::is_asking().
  bool is_asking(const Report& report) const;
  /// Other reports must wait.
  bool is_pending(Instant now) const;
  /// When to request the run's status. nullopt: no doubt needs it.
  std::optional<Instant> next_ask(Instant now) const;

 private:
  /// Each begins with a doubt whose earlier counts are certain.
  std::vector<Reports> groups() const;
  /// The first doubt of its group, or the doubt itself.
  const Report* leader_of(const Report& doubt) const;
  std::string undecidable_reason(const Report& doubt) const;
  Evidence weigh_group(const Reports& group, const icd::RunStatus& status) const;
  ReportBook::Step step_for(const Report& doubt, const Evidence& evidence) const;
  ReportBook::Step missing(const Report& doubt, const Evidence& evidence) const;

  const InquiryPolicy& policy_;
  ReportBook& book_;
  RunAccount& account_;
  const ReportReview& review_;
  std::map<std::int64_t, Inquiry> inquiries_;  // by the first report of a group
  std::map<std::int64_t, Instant> lost_;       // when each doubt came, in this process
};

}  // namespace adit::dispatch
