#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dispatch/doubts.hpp"
#include "dispatch/run_account.hpp"

namespace adit::dispatch {

/// Clients that wait for the answers to reports, and the time of each report's last POST.
class WaitingClients {
 public:
  static constexpr std::chrono::seconds kYoung{10};  // a posted report is for the present run

  /// All outlive this.
  WaitingClients(const ReportBook& book, const RunAccount& account, Output& output)
      : book_(book), account_(account), output_(output) {}

  /// Takes over the clients of `before` with their deadlines.
  void adopt(WaitingClients& before);

  /// The report was posted now: it is meant for the present run.
  void on_posted(std::int64_t number, Instant now) { posted_at_[number] = now; }
  bool is_young(const Report& report, Instant now) const;

  void add(ClientId client, std::int64_t number, Instant deadline) { clients_[client] = {number, deadline}; }
  /// Gives the client the report's stored answer, or Adit's sentence about its state.
  void answer_client(ClientId client, const Report& report);
  /// Answers and removes the clients of a report.
  void answer_all(std::int64_t number);
  /// `number` repeats `earlier`: its clients wait for that, with their deadlines, or get an answer if final.
  void hand_over(std::int64_t number, const Report& earlier);
  /// Answers and removes clients whose time is up.
  void tick(Instant now);
  /// aditd stops: tells and removes all clients. Without `all`, clients of the report in flight wait on.
  void dismiss(bool all);
  bool is_stopping() const { return stopping_; }

  std::optional<std::int64_t> awaited_report(ClientId client) const;
  std::optional<Instant> next_deadline() const;

 private:
  struct Client {
    std::int64_t number = 0;
    Instant deadline;
  };
  template <class Which>
  void answer_matching(Which which);

  const ReportBook& book_;
  const RunAccount& account_;
  Output& output_;
  std::map<ClientId, Client> clients_;         // in the order of arrival
  std::map<std::int64_t, Instant> posted_at_;  // for kYoung
  bool stopping_ = false;                      // for the sentences to clients
};

/// Notices another run or another Command Post, and moves reports into it or holds them.
class RunChanges {
 public:
  /// All outlive this.
  RunChanges(ReportBook& book, RunAccount& account, ReportReview& review, Doubts& doubts,
             WaitingClients& clients)
      : book_(book), account_(account), review_(review), doubts_(doubts), clients_(clients) {}

  /// Reports::prepare_move().
  void prepare_move(const std::string& post, Time time);
  /// The settings name `post`. Keeps queued reports for the old Command Post.
  void change_command_post(const std::string& post, Time time);
  /// Begins or continues another run if the status or the answer is of another one.
  void detect_change(const icd::RunStatus& status, Time time);
  void detect_change(const icd::ReportReply& reply, Time time);
  /// The operator declares a new run. Returns its number.
  std::int64_t declare(Time time);

 private:
  std::vector<Report> steps_to(std::int64_t next, const std::string& why, Time time);
  void judge_name(const icd::RunStatus& status, Time time);
  void detect_name(const std::string& name, const AnotherRun& another, Time time);
  void claim(const std::string& name, Time time);
  void give_back(const Run& earlier, Time time);
  void begin(const AnotherRun& another, std::int64_t may_be, const std::optional<icd::RunStatus>& status,
             Time time);
  void adopt(const Run& known, const std::string& why, Time time);
  enum class Repeats : std::uint8_t { Join, StayHeld };
  void return_to(const Run& known, Repeats repeats, Time time);
  void hand_over(const std::vector<std::int64_t>& repeats);
  void clear_held(Time time);
  void keep_held(const std::vector<Report>& steps);
  bool is_held_for_run(const Report& report) const;

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
