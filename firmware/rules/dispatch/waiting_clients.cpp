#include "dispatch/waiting_clients.hpp"

#include <algorithm>

namespace adit::dispatch {

template <class Which>
std::vector<std::pair<ClientId, std::int64_t>> WaitingClients::take_those(Which which) {
  std::vector<std::pair<ClientId, std::int64_t>> taken;
  std::erase_if(clients_, [&](const auto& item) {
    const bool out = which(item.second);
    if (out) taken.emplace_back(item.first, item.second.number);
    return out;
  });
  return taken;
}

std::vector<ClientId> WaitingClients::take(std::int64_t number) {
  std::vector<ClientId> taken;
  for (const auto& [client, of] :
       take_those([number](const Client& client) { return client.number == number; })) {
    taken.push_back(client);
  }
  return taken;
}

void WaitingClients::hand_over(std::int64_t from, std::int64_t to) {
  for (auto& [id, client] : clients_) {
    if (client.number == from) client.number = to;
  }
}

std::vector<std::pair<ClientId, std::int64_t>> WaitingClients::take_but(std::optional<std::int64_t> number) {
  return take_those([number](const Client& client) { return client.number != number; });
}

std::vector<std::pair<ClientId, std::int64_t>> WaitingClients::take_late(Instant now) {
  return take_those([now](const Client& client) { return client.deadline <= now; });
}

std::optional<std::int64_t> WaitingClients::awaited_by(ClientId client) const {
  const auto found = clients_.find(client);
  return found == clients_.end() ? std::nullopt : std::optional(found->second.number);
}

std::optional<WaitingClients::Instant> WaitingClients::next_deadline() const {
  if (clients_.empty()) return std::nullopt;
  const auto first =
      std::ranges::min_element(clients_, {}, [](const auto& item) { return item.second.deadline; });
  return first->second.deadline;
}

}  // namespace adit::dispatch
