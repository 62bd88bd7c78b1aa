#pragma once

#include <algorithm>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/systemd.hpp"
#include "intake/listen_socket.hpp"
#include "intake/server.hpp"
#include "intake/turnstile.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// The team's listening sockets. They survive a restart by exec or by systemd. Clients that connect meanwhile
/// wait in the kernel's queue.
///
/// The sockets of systemd's unit are the box's doors. They are always served, whatever the settings say, so
/// that the page is reachable. With a door, a missing address (unplugged cable, DHCP) does not prevent a
/// start; without a door it is an error. The other sockets follow the settings, and systemd stores copies.
class ListenSockets {
 public:
  ListenSockets() = default;
  /// An error: a socket of the unit cannot listen.
  static std::expected<ListenSockets, std::string> take_over(std::vector<host::InheritedDescriptor> given);

  /// A copy to serve, and its place.
  struct OpenSocket {
    std::uint64_t number = 0;  // unique in the process
    loop::FileDescriptor socket;
    intake::ListenAddress at;
    bool by_tls = false;  // stunnel connects here
  };
  /// Opens one for each of `team.listen` that no door covers, and the doors. Closes unnamed sockets that are
  /// in the way. An error names the address.
  std::expected<std::vector<OpenSocket>, std::string> open(const settings::Team& team);

  /// State of sockets bound to an interface. A re-plugged adapter is another interface of the same name.
  enum class Reach : std::uint8_t {
    Well,       // or its interface is absent
    Reopen,     // to be opened again
    BySystemd,  // a door: the process must restart
  };
  Reach reach() const;

  /// The sockets for the next process, as from systemd. Ends this object.
  std::vector<host::InheritedDescriptor> hand_over();

  /// Confirms the last open(): closes the other sockets, and stores these at systemd.
  void settle();

 private:
  struct HeldSocket {
    std::uint64_t number = 0;
    std::string name;  // in systemd's store, or of the unit's door
    loop::FileDescriptor socket;
    intake::ListenAddress at;
    bool door = false;
    bool stored = false;
    bool wanted = false;
  };

  bool is_held(const intake::Listen& listen);
  void make_way(std::uint16_t port);
  static void end(const HeldSocket& held);

  std::vector<HeldSocket> held_;
  std::uint64_t last_ = 0;
};

/// Servers at the team's sockets. After a change of the settings servers with the same socket go on. Clients
/// of other sockets are served while they may wait for an answer.
class Listeners {
 public:
  /// All outlive this. `ended`: for each connection that was ended early.
  Listeners(loop::Loop& loop, ListenSockets& sockets, intake::Handler& handler, intake::TokenGuesses& guesses,
            std::function<void(intake::CloseReason why, const std::string& address)> ended)
      : loop_(loop), sockets_(sockets), handler_(handler), guesses_(guesses), ended_(std::move(ended)) {}

  /// Serves these. An error names the address. Sockets in the way may be closed then: call again with the old
  /// settings.
  std::expected<void, std::string> serve(const settings::Team& team);
  /// How long clients of a closed socket are served.
  void set_drain_time(loop::Duration longest) { longest_ = longest; }
  /// Ends unused servers. Call now and then.
  void tick();
  /// Accepts no new connections.
  void stop() {
    for (const ActiveServer& each : serving_) each.server->stop_listening();
  }

  bool serves() const { return !serving_.empty(); }
  /// True if the team can use TLS at port network::kTlsPort.
  bool serves_tls() const { return std::ranges::any_of(serving_, &ActiveServer::by_tls); }
  /// Ports of the served sockets that other machines can reach, also while their last clients are served.
  network::TeamPorts ports() const;
  std::size_t connections() const { return sum(&intake::Server::connections); }
  /// Unauthenticated ones.
  std::size_t unauthenticated_connections() const {
    return sum(&intake::Server::unauthenticated_connections);
  }

 private:
  struct Bounds {
    std::uint32_t connections = 0, per_address = 0;
    friend bool operator==(const Bounds&, const Bounds&) = default;
  };
  struct ActiveServer {
    std::uint64_t socket = 0;  // ListenSockets::OpenSocket::number
    intake::ListenAddress at;
    Bounds bounds;
    bool by_tls = false;
    std::unique_ptr<intake::Server> server;
  };
  /// Accepts no new connections.
  struct DrainingServer {
    intake::ListenAddress at;
    std::unique_ptr<intake::Server> server;
    std::optional<loop::Instant> until;  // nullopt: its socket has a new server with other bounds
  };
  std::expected<ActiveServer, std::string> start(ListenSockets::OpenSocket open, const Bounds& bounds);
  bool has(std::uint64_t socket) const;
  std::size_t sum(std::size_t (intake::Server::*count)() const) const;

  loop::Loop& loop_;
  ListenSockets& sockets_;
  intake::Handler& handler_;
  intake::TokenGuesses& guesses_;
  const std::function<void(intake::CloseReason why, const std::string& address)> ended_;
  loop::Duration longest_{};
  std::vector<ActiveServer> serving_;
  std::vector<DrainingServer> leaving_;
};

}  // namespace adit::gateway
