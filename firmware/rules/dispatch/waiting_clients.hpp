#pragma once

#include <map>
#include <optional>

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
  void carry_on(WaitingClients& before);

  /// The report was posted now: it is meant for the present run.
  void posted(std::int64_t number, Instant now) { posted_at_[number] = now; }
  bool is_young(const Report& report, Instant now) const;

  void add(ClientId client, std::int64_t number, Instant deadline) { clients_[client] = {number, deadline}; }
  /// Gives the client the report's stored answer, or Adit's sentence about its state.
  void tell(ClientId client, const Report& report);
  /// Tells and removes the clients of a report.
  void tell_all(std::int64_t number);
  /// `number` repeats `earlier`: its clients wait for `earlier` with their deadlines, or are told if it is
  /// final.
  void hand_over(std::int64_t number, const Report& earlier);
  /// Tells and removes clients whose time is up.
  void tick(Instant now);
  /// aditd stops: tells and removes all clients. Without `all`, clients of the report in flight wait on.
  void dismiss(bool all);
  bool is_stopping() const { return stopping_; }

  /// The report that a client waits for. nullopt: the client does not wait.
  std::optional<std::int64_t> awaited_by(ClientId client) const;
  std::optional<Instant> next_deadline() const;

 private:
  struct Client {
    std::int64_t number = 0;
    Instant deadline;
  };
  template <class Which>
  void tell_those(Which which);

  const ReportBook& book_;
  const RunAccount& account_;
  Output& output_;
  std::map<ClientId, Client> clients_;         // in the order of arrival
  std::map<std::int64_t, Instant> posted_at_;  // for kYoung
  bool stopping_ = false;                      // for the sentences to clients
};

}  // namespace adit::dispatch
