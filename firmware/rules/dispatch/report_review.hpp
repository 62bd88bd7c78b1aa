#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dispatch/run_account.hpp"

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

  /// The same reports of RunAccount::meant_run(), oldest first.
  std::vector<const Report*> same_in_run(const icd::ArtifactReport& report) const;
  /// The report that this one would repeat in that run, or null.
  const Report* earlier(const Report& report) const;
  /// Another same report of that run, queued or sent, or null.
  const Report* twin(const Report& report) const;
  /// The same report of that run, sent after this one and answered, or null.
  const Report* answered_later(const Report& report) const;
  /// The same report, sent to another Command Post, if this one has not answered yet. Otherwise null.
  const Report* sent_to_other_command_post(const Report& report) const;
  Hold reason_to_hold(const Report& report) const;

  /// The run is unknown: compare the report before it is sent.
  void compare_later(std::int64_t number) { unchecked_.insert(number); }
  bool is_unchecked(std::int64_t number) const { return unchecked_.contains(number); }
  void compared(std::int64_t number) { unchecked_.erase(number); }

  /// The reason for a report that waits for an undo. Empty if the rules give no time for it.
  Hold hold_for_undo() const;
  void await_undo(std::int64_t number, Time time);
  bool awaits_undo(std::int64_t number) const { return undo_.contains(number); }
  void undo_over(std::int64_t number);
  /// When a held report is sent unless the operator withdraws it, in seconds since 1970. nullopt: the
  /// operator decides, or it is not held.
  std::optional<double> sends_at(std::int64_t number) const;
  std::optional<Instant> next_undo() const;
  /// Reports whose time is over. Their next time is a second later, in case that a write fails.
  std::vector<std::int64_t> late_undos(Instant now);
  /// Ends all waits, and returns their reports. The operator decides.
  std::vector<std::int64_t> end_undos();
  /// The operator decides: ends the wait and the comparison.
  void decided(std::int64_t number);

 private:
  /// The time for an undo of a held report. It is in no file, so that a restart leaves the report held.
  struct Undo {
    Instant until;
    double stamp;  // the same, in seconds since 1970
  };

  Hold maybe_repeat(const Report& report) const;
  const Report* sent_elsewhere(const Report& report, const std::function<bool(const Run&)>& counts) const;

  const ReportRules& rules_;
  const ReportBook& book_;
  const RunAccount& account_;
  std::set<std::int64_t> unchecked_;  // not compared yet, because the run was unknown
  std::map<std::int64_t, Undo> undo_;
};

}  // namespace adit::dispatch
