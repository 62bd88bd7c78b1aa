#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

/// How chronyd stands, as it tells whoever asks on this machine: version 6 of its protocol (candm.h of chrony
/// 4), command "tracking".
namespace adit::clock {

struct Tracking {
  std::uint32_t server = 0;  // the IPv4 address that it goes by; 0: none
  double heard = 0;          // when it was heard last, in seconds since 1970 by the system's clock
  double behind = 0;         // seconds by which the system's clock was behind the server's then
};

/// The reply to it is as long.
using TrackingRequest = std::array<std::uint8_t, 104>;
/// `number` is in its reply.
TrackingRequest tracking_request(std::uint32_t number);
/// Nothing where these bytes are no reply to that request.
std::optional<Tracking> read_tracking(std::span<const std::uint8_t> reply, std::uint32_t number);

}  // namespace adit::clock
