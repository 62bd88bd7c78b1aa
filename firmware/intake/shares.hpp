#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "loop/loop.hpp"

namespace adit::intake {

/// How many connections there may be at once. A client that has shown a token (or a session) is known; all
/// others are strangers, with a small share of their own: however many come, known clients have room.
struct Shares {
  std::uint32_t strangers = 0, known = 0;
  std::uint32_t known_of_address = 0;

  /// Of `connections` in all, of which one address may have `of_address`.
  static Shares of(std::uint32_t connections, std::uint32_t of_address);
};

/// One connection, as the shares see it.
struct Held {
  enum class Doing : std::uint8_t {
    Fresh,    // just taken in, and what it has sent was not looked at yet
    Idle,     // between requests
    Sending,  // its head or its body is not whole
    Left,     // it waits for its answer, and has ended its own direction: it may have hung up
    Waiting,  // for its answer, or reads it
  };

  std::uint64_t number = 0;  // the lower the older
  std::string_view address;
  bool known = false;
  Doing doing = Doing::Sending;
  loop::Instant since{};  // it does that
};

/// The number of the connection in `held` that is closed if there are more strangers than their share. It is
/// one of the address that has most strangers: an idle one, or else the oldest. Nothing if there are not too
/// many, or if all others are fresh: they may be about to show a token.
std::optional<std::uint64_t> stranger_to_go(std::span<const Held> held, const Shares& shares);

/// Whether there is room for one more who is known, and who gives way for it.
struct Room {
  bool is_there = true;
  std::optional<std::uint64_t> gives_way;  // Held::number
};

/// For a request from `address` that has shown a token, on a connection that is not among `others`. The one
/// that gives way is the one that has been idle longest; or one that may have hung up; or, if another address
/// has more connections than this one would then have, the oldest of that address whose request is not whole.
/// A known client that waits for the answer to a whole request never gives way.
Room room_for(std::string_view address, std::span<const Held> others, const Shares& shares);

}  // namespace adit::intake
