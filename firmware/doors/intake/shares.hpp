#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "loop/loop.hpp"

namespace adit::intake {

/// Limits of simultaneous connections. Unauthenticated connections have a small share of their own, so that
/// authenticated ones (with a token or a session) always have room.
struct Shares {
  std::uint32_t unauthenticated = 0, known = 0;
  std::uint32_t known_of_address = 0;

  /// Splits `connections`, of which one address may have `of_address`.
  static Shares split(std::uint32_t connections, std::uint32_t of_address);
};

struct ConnectionInfo {
  enum class Activity : std::uint8_t {
    Fresh,    // accepted, and its bytes were not checked yet
    Idle,     // between requests
    Sending,  // its head or its body is not whole
    Left,     // waits for its answer and has closed its direction, so it may have hung up
    Waiting,  // waits for its answer or reads it
  };

  std::uint64_t number = 0;  // a lower number is older
  std::string_view address;
  bool known = false;
  Activity doing = Activity::Sending;
  loop::Instant since{};  // the start of that state
};

/// The number of the unauthenticated connection to close, or nullopt if they are within their share or all
/// fresh. It belongs to the address with most such connections: an idle one, or else the oldest. Fresh
/// connections are not closed, because they may be about to show a token.
std::optional<std::uint64_t> unauthenticated_to_close(std::span<const ConnectionInfo> held,
                                                      const Shares& shares);

/// Whether one more authenticated request has room, and the connection that gives way for it.
struct Room {
  bool is_there = true;
  std::optional<std::uint64_t> gives_way;  // ConnectionInfo::number
};

/// For a request from `address` that has shown a token, on a connection that is not among `others`. The
/// connection that gives way is the one idle longest; or one that may have hung up; or, if another address
/// has more connections than this one would then have, the oldest of that address whose request is not whole.
/// An authenticated client that waits for the answer to a whole request never gives way.
Room room_for(std::string_view address, std::span<const ConnectionInfo> others, const Shares& shares);

}  // namespace adit::intake
