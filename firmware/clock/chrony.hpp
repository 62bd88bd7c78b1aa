#pragma once

#include <string>

#include "clock/messages.hpp"

/// What chronyd is told, which speaks NTP for Adit: adit-ntp.service.
namespace adit::clock {

/// Files by name, in adit-clock's runtime folder.
inline constexpr const char* kConfigurationFile = "chrony.conf";  // chrony.conf(5)
inline constexpr const char* kOptionsFile = "chrony.options";     // of its command line, for systemd
inline constexpr const char* kFirewallFile = "chrony.nft";        // what the firewall lets in for it

struct Chrony {
  std::string configuration, options, firewall;
  friend bool operator==(const Chrony&, const Chrony&) = default;
};

/// Where `source` set the time of day last. chronyd keeps a clock that the server's time was set to, and
/// never moves it by more than a minute; else it only measures, and who may set the clock is to_be_set()'s.
/// It gives the time to `clients` while it is known. It is bound to `interface`. Requires what read() gives;
/// and that NTP is on.
Chrony chrony_for(const Ntp& ntp, Source source, const std::string& interface);

}  // namespace adit::clock
