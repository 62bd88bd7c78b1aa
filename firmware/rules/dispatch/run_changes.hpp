#pragma once

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
  void claim(const std::string& name, Time time);
  void begin(const std::string& why, std::int64_t may_be, const std::optional<icd::RunStatus>& status,
             Time time);
  void take_up(const Run& known, const std::string& why, Time time);
  void return_to(const Run& known, Time time);
  void hand_over(const std::vector<std::int64_t>& repeats);
  void clear_held(Time time);

  const InquiryPolicy& policy_;
  ReportBook& book_;
  RunAccount& account_;
  ReportReview& review_;
  Doubts& doubts_;
  WaitingClients& clients_;
};

}  // namespace adit::dispatch
