#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "clock/messages.hpp"

/// Configuration of chronyd, which speaks NTP for Adit (adit-ntp.service).
namespace adit::clock {

/// State of chronyd by its protocol, version 6 (candm.h of chrony 4), command "tracking".
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

/// Files in adit-clock's runtime directory.
inline constexpr const char* kConfigurationFile = "chrony.conf";  // chrony.conf(5)
inline constexpr const char* kOptionsFile = "chrony.options";     // command-line options, for systemd
inline constexpr const char* kFirewallFile = "chrony.nft";        // firewall rules

struct Chrony {
  std::string configuration, options, firewall;
  friend bool operator==(const Chrony&, const Chrony&) = default;
};

/// Configuration for a time of day that `source` set last. If that is the server of `ntp`, chronyd steers the
/// clock, by at most a minute in one step; else it only measures, because time_to_set() decides. chronyd
/// serves the clients of `ntp` once the time is_set(), and is bound to `interface`. Requires ntp.is_on().
Chrony chrony_for(const Ntp& ntp, Source source, const std::string& interface);

}  // namespace adit::clock
