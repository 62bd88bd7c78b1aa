#include "gateway/listeners.hpp"

#include <algorithm>
#include <utility>

#include "host/log.hpp"
#include "icd/try.hpp"

namespace adit::gateway {

std::expected<void, std::string> Listeners::serve(const settings::Team& team) {
  const Bounds bounds{team.connections, team.connections_per_address};
  auto open = ADIT_TRY(sockets_.open(team));
  std::vector<Serving> begun;
  std::vector<std::uint64_t> stay;
  for (ListenSockets::Open& each : open) {
    const auto same = [&](const Serving& it) { return it.socket == each.number && it.bounds == bounds; };
    if (std::ranges::any_of(serving_, same)) {
      stay.push_back(each.number);
      continue;
    }
    auto started = ADIT_TRY(start(std::move(each), bounds));
    begun.push_back(std::move(started));
  }
  std::vector<Serving> before = std::exchange(serving_, std::move(begun));
  for (Serving& each : before) {
    if (std::ranges::find(stay, each.socket) != stay.end()) {
      serving_.push_back(std::move(each));
      continue;
    }
    each.server->stop_listening();
    const bool bounds_alone = has(each.socket);
    leaving_.push_back(
        {std::move(each.server), bounds_alone ? std::nullopt : std::optional(loop_.now() + longest_)});
  }
  return {};
}

std::expected<Listeners::Serving, std::string> Listeners::start(ListenSockets::Open open,
                                                                const Bounds& bounds) {
  auto server = ADIT_TRY(intake::Server::start(loop_,
                                               {.address = open.at.address,
                                                .port = open.at.port,
                                                .interface = open.at.interface,
                                                .connections = bounds.connections,
                                                .connections_per_address = bounds.per_address,
                                                .guesses = &guesses_,
                                                .ended = ended_},
                                               handler_, std::move(open.socket)));
  host::log(host::Level::Notice, "listening",
            {{"address", open.at.address},
             {"port", std::to_string(open.at.port)},
             {"interface", open.at.interface}});
  return Serving{open.number, bounds, std::move(server)};
}

bool Listeners::has(std::uint64_t socket) const {
  return std::ranges::find(serving_, socket, &Serving::socket) != serving_.end();
}

void Listeners::tick() {
  const loop::Instant now = loop_.now();
  std::erase_if(leaving_, [now](const Leaving& each) {
    return each.server->connections() == 0 || (each.until && now >= *each.until);
  });
}

void Listeners::stop() {
  for (const Serving& each : serving_) each.server->stop_listening();
}

std::size_t Listeners::sum(std::size_t (intake::Server::*count)() const) const {
  std::size_t sum = 0;
  for (const Serving& each : serving_) sum += (*each.server.*count)();
  for (const Leaving& each : leaving_) sum += (*each.server.*count)();
  return sum;
}

}  // namespace adit::gateway
