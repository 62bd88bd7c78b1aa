#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include "dispatch/output.hpp"

namespace adit::dispatch {

/// The clients that wait for the answer to a report, several for one if they posted it again.
class WaitingClients {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  void add(ClientId client, std::int64_t number, Instant deadline) { clients_[client] = {number, deadline}; }
  /// Takes out those that wait for a report.
  std::vector<ClientId> take(std::int64_t number);
  /// Those that wait for `from` wait for `to` from now on, no longer than they would have.
  void hand_over(std::int64_t from, std::int64_t to);
  /// Takes out all but those that wait for one report.
  std::vector<std::pair<ClientId, std::int64_t>> take_but(std::optional<std::int64_t> number);
  /// Takes out those whose time is up.
  std::vector<std::pair<ClientId, std::int64_t>> take_late(Instant now);
  std::optional<std::int64_t> awaited_by(ClientId client) const;
  std::optional<Instant> next_deadline() const;

 private:
  struct Client {
    std::int64_t number = 0;
    Instant deadline;
  };
  template <class Which>
  std::vector<std::pair<ClientId, std::int64_t>> take_those(Which which);

  std::map<ClientId, Client> clients_;  // as they came, so that the first deadline is the first's
};

}  // namespace adit::dispatch
