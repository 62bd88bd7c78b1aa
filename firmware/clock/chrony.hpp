#pragma once

#include <string>

#include "clock/messages.hpp"

/// Configuration of chronyd, which speaks NTP for Adit (adit-ntp.service).
namespace adit::clock {

/// Files in adit-clock's runtime directory.
inline constexpr const char* kConfigurationFile = "chrony.conf";  // chrony.conf(5)
inline constexpr const char* kOptionsFile = "chrony.options";     // command-line options, for systemd
inline constexpr const char* kFirewallFile = "chrony.nft";        // firewall rules

struct Chrony {
  std::string configuration, options, firewall;
  friend bool operator==(const Chrony&, const Chrony&) = default;
};

/// Configuration for a time of day that `source` set last. If that is the server of `ntp`, chronyd steers the
/// clock, by at most a minute in one step; otherwise it only measures, because to_be_set() decides. chronyd
/// serves the clients of `ntp` once the time is reliable (is_set()). It is bound to `interface`. Requires
/// ntp.is_on().
Chrony chrony_for(const Ntp& ntp, Source source, const std::string& interface);

}  // namespace adit::clock
