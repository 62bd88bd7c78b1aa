#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include "dispatch/output.hpp"

namespace adit::dispatch {

/// Clients per report.
class WaitingClients {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  void add(ClientId client, std::int64_t number, Instant deadline) { clients_[client] = {number, deadline}; }
  /// Removes and returns the clients of a report.
  std::vector<ClientId> take(std::int64_t number);
  /// Moves the clients of `from` to `to`, with their deadlines.
  void hand_over(std::int64_t from, std::int64_t to);
  /// Removes and returns all clients but those of one report.
  std::vector<std::pair<ClientId, std::int64_t>> take_but(std::optional<std::int64_t> number);
  /// Removes and returns clients whose time is up.
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

  std::map<ClientId, Client> clients_;  // in the order of arrival
};

}  // namespace adit::dispatch
