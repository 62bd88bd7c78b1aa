#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/listen_sockets.hpp"
#include "intake/server.hpp"
#include "intake/token_guesses.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// Servers at the team's sockets. After a change of the settings servers with the same socket go on. Clients
/// of other sockets are served while they may wait for an answer.
class Listeners {
 public:
  /// All outlive this. `ended`: for each connection that was ended early.
  Listeners(loop::Loop& loop, ListenSockets& sockets, intake::Handler& handler, intake::TokenGuesses& guesses,
            std::function<void(intake::Ended why, const std::string& address)> ended)
      : loop_(loop), sockets_(sockets), handler_(handler), guesses_(guesses), ended_(std::move(ended)) {}

  /// Serves these. An error names the address. Sockets in the way may be closed then: call again
  /// with the old settings.
  std::expected<void, std::string> serve(const settings::Team& team);
  /// How long clients of a closed socket are served.
  void let_go_within(loop::Duration longest) { longest_ = longest; }
  /// Ends unused servers. Call now and then.
  void tick();
  /// Accepts no new connections.
  void stop();

  bool serves() const { return !serving_.empty(); }
  std::size_t connections() const { return sum(&intake::Server::connections); }
  /// Unauthenticated ones.
  std::size_t unauthenticated() const { return sum(&intake::Server::unauthenticated); }

 private:
  struct Bounds {
    std::uint32_t connections = 0, per_address = 0;
    friend bool operator==(const Bounds&, const Bounds&) = default;
  };
  struct Serving {
    std::uint64_t socket = 0;  // ListenSockets::Open::number
    Bounds bounds;
    std::unique_ptr<intake::Server> server;
  };
  /// Accepts no new connections.
  struct Leaving {
    std::unique_ptr<intake::Server> server;
    std::optional<loop::Instant> until;  // nullopt: its socket has a new server with other bounds
  };
  std::expected<Serving, std::string> start(ListenSockets::Open open, const Bounds& bounds);
  bool has(std::uint64_t socket) const;
  std::size_t sum(std::size_t (intake::Server::*count)() const) const;

  loop::Loop& loop_;
  ListenSockets& sockets_;
  intake::Handler& handler_;
  intake::TokenGuesses& guesses_;
  const std::function<void(intake::Ended why, const std::string& address)> ended_;
  loop::Duration longest_{};
  std::vector<Serving> serving_;
  std::vector<Leaving> leaving_;
};

}  // namespace adit::gateway
