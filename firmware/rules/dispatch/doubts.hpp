#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dispatch/report_review.hpp"

namespace adit::dispatch {

/// Decides reports in doubt: asks for the run's status until an Inquiry has the result, or the operator
/// decides.
///
/// A doubt whose earlier counts are certain is decided with those that follow it before it is counted: a
/// group. Any other one is the operator's. A doubt is counted by the first status that is requested
/// `doubt_for` after its loss, unless the clock stands in a stop. Until then it may explain a change of the
/// counts.
class Doubts {
 public:
  using Reports = std::vector<const Report*>;

  static constexpr std::int64_t kMostTries = 5;  // losses until a report is held

  /// All outlive this.
  Doubts(const InquiryPolicy& policy, ReportBook& book, RunAccount& account, const ReportReview& review)
      : policy_(policy), book_(book), account_(account), review_(review) {}

  /// In doubt in the present run, in the order of sending.
  Reports all() const { return book_.doubts(account_.run().number); }
  /// Call at a start, before begin(). Reports of a box that this one replaces may have come into doubt
  /// together.
  void open();
  /// Starts again, for all() doubts. Call it if one is added or leaves, or with another run.
  void begin(Instant now);
  /// Report `number` came into doubt.
  void lost(std::int64_t number, Instant now);
  /// A status that was requested at `asked`. Returns the steps that it decides: of all reports of a group, or
  /// none.
  std::vector<ReportBook::Step> hear(const icd::RunStatus& status, Instant asked, Time time);
  /// After the steps of hear(): the doubts that this status counts.
  void count(Instant asked, Time time);
  void failed(Time time);

  /// True if a report that is sent now and lost would be decided with an earlier one.
  bool has_open_group() const;
  /// Of the operator's doubts, those that may still explain a change of the counts.
  std::int64_t open_count() const;

  /// Notes the state of the inquiry in `doubts`. `seen`: what the last status showed.
  void explain(const Reports& doubts, const std::string& seen, Time time);
  /// Call it before the operator's decision about `decided` is written: forgets the expected counts of other
  /// doubts, which no longer show the result, so that a power cut between leaves no wrong evidence. False:
  /// the write failed.
  bool blur(std::int64_t decided, Time time);
  /// After the operator's decision.
  void ask_for_others(Time time);
  /// The counts no longer show what became of all(): the operator decides.
  void leave_to_operator(const std::string& why, Time time);

  /// True if the report is in doubt and Adit still asks about it.
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
  std::string undecidable(const Report& doubt) const;
  Evidence weigh_group(const Reports& group, const icd::RunStatus& status) const;
  ReportBook::Step found(const Report& doubt, const Evidence& evidence) const;
  ReportBook::Step missing(const Report& doubt, const Evidence& evidence) const;

  const InquiryPolicy& policy_;
  ReportBook& book_;
  RunAccount& account_;
  const ReportReview& review_;
  std::map<std::int64_t, Inquiry> inquiries_;  // by the first report of a group
  std::map<std::int64_t, Instant> lost_;       // when each doubt came, in this process
};

}  // namespace adit::dispatch
