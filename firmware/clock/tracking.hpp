#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

/// State of chronyd by its protocol, version 6 (candm.h of chrony 4), command "tracking".
namespace adit::clock {

struct Tracking {
  std::uint32_t server = 0;  // IPv4 address of the selected server; 0: not selected
  double heard = 0;          // last contact, in seconds since 1970 by the system clock
  double behind = 0;         // seconds by which the system clock was then behind the server
};

/// As long as the reply.
using TrackingRequest = std::array<std::uint8_t, 104>;
/// `number` is returned in the reply.
TrackingRequest tracking_request(std::uint32_t number);
/// std::nullopt if the bytes are not a reply to that request.
std::optional<Tracking> read_tracking(std::span<const std::uint8_t> reply, std::uint32_t number);

}  // namespace adit::clock
