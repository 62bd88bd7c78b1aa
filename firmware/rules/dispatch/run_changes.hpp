#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dispatch/doubts.hpp"
#include "dispatch/waiting_clients.hpp"

namespace adit::dispatch {

/// Notices another run or another Command Post, and moves reports into it or holds them.
class RunChanges {
 public:
  /// All outlive this.
  RunChanges(const InquiryPolicy& policy, ReportBook& book, RunAccount& account, ReportReview& review,
             Doubts& doubts, WaitingClients& clients)
      : policy_(policy),
        book_(book),
        account_(account),
        review_(review),
        doubts_(doubts),
        clients_(clients) {}

  /// Reports::will_move().
  void will_move(const std::string& post, Time time);
  /// The settings name `post`. Keeps queued reports for the old Command Post.
  void change_post(const std::string& post, Time time);
  /// Begins or continues another run if the status or the answer is of another one.
  void meet(const icd::RunStatus& status, Time time);
  void meet(const icd::ReportReply& reply, Time time);
  /// The operator declares a new run. Returns its number.
  std::int64_t declare(Time time);

 private:
  std::vector<Report> steps_into(std::int64_t next, const std::string& why, Time time);
  void judge_name(const icd::RunStatus& status, Time time);
  void meet_name(const std::string& name, const AnotherRun& another, Time time);
  void claim(const std::string& name, Time time);
  void give_back(const Run& earlier, Time time);
  void begin(const AnotherRun& another, std::int64_t may_be, const std::optional<icd::RunStatus>& status,
             Time time);
  void take_up(const Run& known, const std::string& why, Time time);
  enum class Repeats : std::uint8_t { Join, StayHeld };
  void return_to(const Run& known, Repeats repeats, Time time);
  void hand_over(const std::vector<std::int64_t>& repeats);
  void clear_held(Time time);
  void keep_held(const std::vector<Report>& steps);
  bool is_held_for_run(const Report& report) const;

  const InquiryPolicy& policy_;
  ReportBook& book_;
  RunAccount& account_;
  ReportReview& review_;
  Doubts& doubts_;
  WaitingClients& clients_;
  /// Reports held because another run seemed to begin, and the times of that. They are queued again if it did
  /// not begin. In memory only: after a restart the operator decides.
  std::map<std::int64_t, double> held_;
};

}  // namespace adit::dispatch
