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

/// The servers at the team's sockets. Where the settings change, those whose socket stays go on, and whoever
/// is connected to another is served for as long as he can be waiting for an answer.
class Listeners {
 public:
  /// All outlive this. `ended`: told of each connection that was not gone on with.
  Listeners(loop::Loop& loop, ListenSockets& sockets, intake::Handler& handler, intake::TokenGuesses& guesses,
            std::function<void(intake::Ended why, const std::string& address)> ended)
      : loop_(loop), sockets_(sockets), handler_(handler), guesses_(guesses), ended_(std::move(ended)) {}

  /// From now on at these. An error says what cannot be listened at: then sockets that were in the way may be
  /// closed, and it has to be told again what was served before.
  std::expected<void, std::string> serve(const settings::Team& team);
  /// Who is connected to a socket that is served no more is served for so long.
  void let_go_within(loop::Duration longest) { longest_ = longest; }
  /// Lets go of servers that nobody needs any more; called now and then.
  void tick();
  /// Takes no new connections.
  void stop();

  bool serves() const { return !serving_.empty(); }
  std::size_t connections() const { return sum(&intake::Server::connections); }
  /// Those of them that have shown no token.
  std::size_t strangers() const { return sum(&intake::Server::strangers); }

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
  /// Takes no new connections.
  struct Leaving {
    std::unique_ptr<intake::Server> server;
    std::optional<loop::Instant> until;  // nothing: its socket is served by another, with other bounds
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
