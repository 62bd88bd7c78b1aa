#include "gateway/listeners.hpp"

#include <fcntl.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <utility>

#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::gateway {
namespace {

constexpr std::string_view kStored = "listen-";  // no socket unit of Adit has this name
constexpr std::string_view kTls = "tls";         // FileDescriptorName= of adit-tls-plain.socket

/// The name in systemd's store: "listen-team0-10.0.0.1-8000", with the settings' port, which may be 0.
std::string name_of(const intake::Listen& listen) {
  std::string address = listen.address;
  std::ranges::replace(address, ':', '_');
  return icd::sentence(kStored, listen.interface, "-", address, "-", listen.port);
}

}  // namespace

std::expected<ListenSockets, std::string> ListenSockets::take_over(
    std::vector<host::InheritedDescriptor> given) {
  ListenSockets sockets;
  for (host::InheritedDescriptor& each : given) {
    HeldSocket held{.number = ++sockets.last_,
                    .name = std::move(each.name),
                    .socket = std::move(each.descriptor),
                    .at = {}};
    held.stored = held.name.starts_with(kStored);
    held.door = !held.stored;
    if (intake::is_orphaned(held.socket.get())) {
      host::log(host::Level::Warning, "unusable socket from systemd: its interface is gone",
                {{"name", held.name}});
      end(held);
      continue;
    }
    auto bound = intake::bound_at(held.socket.get());
    if (bound) {
      held.at = std::move(*bound);
      sockets.held_.push_back(std::move(held));
    } else if (held.door) {
      return std::unexpected(
          icd::sentence("the socket ", icd::quote_text(held.name), " from systemd: ", bound.error()));
    } else {
      host::log(host::Level::Warning, "unusable socket from systemd",
                {{"name", held.name}, {"why", bound.error()}});
      end(held);
    }
  }
  return sockets;
}

std::expected<std::vector<ListenSockets::OpenSocket>, std::string> ListenSockets::open(
    const settings::Team& team) {
  for (HeldSocket& held : held_) held.wanted = held.door;
  const bool has_door = std::ranges::any_of(held_, &HeldSocket::door);
  std::vector<intake::Listen> missing;
  for (const settings::Address& address : team.listen) {
    intake::Listen listen{
        .address = address.address, .port = address.port, .interface = team.interface, .free_bind = has_door};
    if (!is_held(listen)) missing.push_back(std::move(listen));
  }
  for (const intake::Listen& listen : missing) make_way(listen.port);
  for (const intake::Listen& listen : missing) {
    auto socket = ADIT_TRY(intake::open_listen_socket(listen));
    auto at = ADIT_TRY(intake::bound_at(socket.get()));
    held_.push_back({.number = ++last_,
                     .name = name_of(listen),
                     .socket = std::move(socket),
                     .at = std::move(at),
                     .wanted = true});
  }
  std::vector<OpenSocket> open;
  for (const HeldSocket& held : held_) {
    if (!held.wanted || intake::is_orphaned(held.socket.get())) continue;
    loop::FileDescriptor copy(fcntl(held.socket.get(), F_DUPFD_CLOEXEC, 0));
    if (!copy) return std::unexpected(icd::sentence("copying a socket: ", std::strerror(errno)));
    ADIT_TRY(intake::adopt_listen_socket(copy.get(), {}));
    open.push_back({held.number, std::move(copy), held.at, held.door && held.name == kTls});
  }
  return open;
}

ListenSockets::Reach ListenSockets::reach() const {
  Reach reach = Reach::Well;
  for (const HeldSocket& held : held_) {
    if (held.at.interface.empty() || !intake::is_orphaned(held.socket.get())) continue;
    if (if_nametoindex(held.at.interface.c_str()) == 0) continue;
    if (held.door) return Reach::BySystemd;
    reach = Reach::Reopen;
  }
  return reach;
}

void ListenSockets::settle() {
  for (const HeldSocket& held : held_) {
    if (!held.wanted) end(held);
  }
  std::erase_if(held_, [](const HeldSocket& held) { return !held.wanted; });
  for (HeldSocket& held : held_) {
    if (held.door || std::exchange(held.stored, true)) continue;
    host::store_descriptor(held.name, held.socket.get());
  }
}

/// systemd has copies of these. The next start opens the others.
std::vector<host::InheritedDescriptor> ListenSockets::hand_over() {
  std::vector<host::InheritedDescriptor> given;
  for (HeldSocket& held : held_) {
    if (held.door || held.stored) given.push_back({std::move(held.name), std::move(held.socket)});
  }
  held_.clear();
  return given;
}

/// Entries with port 0 at one address get different sockets.
bool ListenSockets::is_held(const intake::Listen& listen) {
  const std::string name = name_of(listen);
  for (HeldSocket& held : held_) {
    if (held.door ? held.name == kTls || !intake::covers(held.at, listen) : held.wanted || held.name != name)
      continue;
    if (intake::is_orphaned(held.socket.get())) continue;
    held.wanted = true;
    return true;
  }
  return false;
}

/// "0.0.0.0" cannot be bound beside 10.0.0.1 at the same port.
void ListenSockets::make_way(std::uint16_t port) {
  std::erase_if(held_, [port](const HeldSocket& held) {
    const bool goes = !held.wanted && held.at.port == port;
    if (goes) end(held);
    return goes;
  });
}

/// Shuts down all copies at once, because systemd closes its own later.
void ListenSockets::end(const HeldSocket& held) {
  shutdown(held.socket.get(), SHUT_RDWR);
  if (!held.door) host::forget_descriptor(held.name);
}

std::expected<void, std::string> Listeners::serve(const settings::Team& team) {
  const Bounds bounds{team.connections, team.connections_per_address};
  auto open = ADIT_TRY(sockets_.open(team));
  std::vector<ActiveServer> begun;
  std::vector<std::uint64_t> stay;
  for (ListenSockets::OpenSocket& each : open) {
    const auto same = [&](const ActiveServer& it) { return it.socket == each.number && it.bounds == bounds; };
    if (std::ranges::any_of(serving_, same)) {
      stay.push_back(each.number);
      continue;
    }
    auto started = ADIT_TRY(start(std::move(each), bounds));
    begun.push_back(std::move(started));
  }
  std::vector<ActiveServer> before = std::exchange(serving_, std::move(begun));
  for (ActiveServer& each : before) {
    if (std::ranges::find(stay, each.socket) != stay.end()) {
      serving_.push_back(std::move(each));
      continue;
    }
    each.server->stop_listening();
    const bool bounds_alone = has(each.socket);
    leaving_.push_back({std::move(each.at), std::move(each.server),
                        bounds_alone ? std::nullopt : std::optional(loop_.now() + longest_)});
  }
  return {};
}

std::expected<Listeners::ActiveServer, std::string> Listeners::start(ListenSockets::OpenSocket open,
                                                                     const Bounds& bounds) {
  auto server = ADIT_TRY(intake::Server::start(loop_,
                                               {.address = open.at.address,
                                                .port = open.at.port,
                                                .interface = open.at.interface,
                                                .by_tls = open.by_tls,
                                                .connections = bounds.connections,
                                                .connections_per_address = bounds.per_address,
                                                .guesses = &guesses_,
                                                .on_ended = ended_},
                                               handler_, std::move(open.socket)));
  host::log(host::Level::Notice, "listening",
            {{"address", open.at.address},
             {"port", std::to_string(open.at.port)},
             {"interface", open.at.interface}});
  return ActiveServer{open.number, std::move(open.at), bounds, open.by_tls, std::move(server)};
}

network::TeamPorts Listeners::ports() const {
  std::set<std::uint16_t> all;
  const auto add = [&all](const intake::ListenAddress& at) {
    if (!intake::is_loopback(at.address)) all.insert(at.port);
  };
  for (const ActiveServer& each : serving_) add(each.at);
  if (serves_tls()) all.insert(network::kTlsPort);
  for (const DrainingServer& each : leaving_) add(each.at);
  network::TeamPorts ports{{all.begin(), all.end()}};
  ports.ports.resize(std::min(all.size(), network::kMostTeamPorts));
  return ports;
}

bool Listeners::has(std::uint64_t socket) const {
  return std::ranges::find(serving_, socket, &ActiveServer::socket) != serving_.end();
}

void Listeners::tick() {
  const loop::Instant now = loop_.now();
  std::erase_if(leaving_, [now](const DrainingServer& each) {
    return each.server->connections() == 0 || (each.until && now >= *each.until);
  });
}

std::size_t Listeners::sum(std::size_t (intake::Server::*count)() const) const {
  std::size_t sum = 0;
  for (const ActiveServer& each : serving_) sum += (*each.server.*count)();
  for (const DrainingServer& each : leaving_) sum += (*each.server.*count)();
  return sum;
}

}  // namespace adit::gateway
