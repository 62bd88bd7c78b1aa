#include "simulation/door.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>

#include "intake/listen_socket.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr std::chrono::microseconds kAccepting{50};
/// The limits in the settings (Box): connections of one address that may have shown a token, plus the share
/// of unauthenticated ones. A connection that gives way is gone kGivesWay later.
constexpr std::size_t kMostConnections = 64, kMostOfAddress = 8 + 16;
constexpr std::chrono::milliseconds kGone{20};

}  // namespace

Door::~Door() {
  for (const Waiting& each : waiting_) ::close(each.fd);
}

int Door::connect(const std::string& address) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) std::abort();
  in_addr parsed{};
  ::inet_pton(AF_INET, address.c_str(), &parsed);
  waiting_.push_back({ends[1], ends[0], parsed.s_addr});
  world_.after(kAccepting, [this] { world_.when_moving([this] { admit_all(); }); });
  return ends[0];
}

void Door::closed(int fd) {
  clients_.erase(fd);
}

std::shared_ptr<void> Door::open(int listening, intake::Admit admit) {
  const auto bound = intake::bound_at(listening);
  if (!bound || bound->interface != interface_) {
    world_.note({.kind = Kind::Forbidden,
                 .what = kListen,
                 .who = "",
                 .text = bound ? "bound to '" + bound->interface + "'" : bound.error()});
  }
  admit_ = std::move(admit);
  const auto token = std::make_shared<int>(0);
  token_ = token;
  ++server_;
  world_.after(kAccepting, [this] { admit_all(); });
  return token;
}

void Door::cut() {
  token_.reset();
  admit_ = nullptr;
  for (const int fd : clients_) ::shutdown(fd, SHUT_RD);
  clients_.clear();
}

void Door::admit_all() {
  while (!waiting_.empty() && admit_ && !token_.expired()) {
    const Waiting next = waiting_.front();
    waiting_.pop_front();
    clients_.insert(next.client);
    sockaddr_in peer{};
    peer.sin_family = AF_INET;
    peer.sin_addr.s_addr = next.address;
    peer.sin_port = htons(40000);
    served_[next.fd] = {next.address, server_};
    admit_(next.fd, reinterpret_cast<const sockaddr*>(&peer), sizeof peer);  // may close it at once
    world_.after(kGone,
                 [this, address = next.address] { world_.when_moving([this, address] { count(address); }); });
  }
}

void Door::count(std::uint32_t address) {
  std::size_t all = 0, of_address = 0;
  for (const auto& [fd, each] : served_) {
    if (each.server != server_) continue;
    ++all;
    if (each.address == address) ++of_address;
  }
  if (all <= kMostConnections && of_address <= kMostOfAddress) return;
  world_.note(
      {.kind = Kind::Forbidden,
       .what = kTooMuch,
       .who = "",
       .text = std::to_string(all) + " connections, " + std::to_string(of_address) + " of one address"});
}

}  // namespace adit::simulation

namespace adit::intake {

std::shared_ptr<void> accept_instead(int listening, Admit admit) {
  return simulation::World::current().door().open(listening, std::move(admit));
}

}  // namespace adit::intake
