#pragma once

#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "settings/subnet.hpp"

namespace adit::host {

/// A network interface as the kernel has it now.
struct Interface {
  std::string name;
  bool up = false;
  std::optional<bool> carrier;
  std::vector<std::string> addresses;  // "10.0.0.1/24", "fe80::1/64"
};

/// What the driver tells of a port.
struct Port {
  std::string mac;               // "02:00:00:00:00:01"; "": it has none
  std::optional<unsigned> mbit;  // of the link; nothing: there is none, or the driver does not tell
  std::string duplex;            // "full", "half"; "": not told
};

/// By the kernel's list of interfaces in `sys_class_net`; nothing where there is no such interface.
std::optional<Port> port_in(const std::string& sys_class_net, const std::string& interface);
std::optional<Port> port(const std::string& interface);

/// What this machine is called in mDNS: "adit.local" (RFC 6762 3).
std::string local_name();

/// All of them in the kernel's order, or why they cannot be told (getifaddrs(3)).
std::expected<std::vector<Interface>, std::string> interfaces();

/// All IPv4 addresses of an interface, link-local ones last (the kernel has them first); none where there is
/// no such interface.
std::vector<settings::Subnet> own_addresses(const std::string& interface);

/// The first of them.
std::optional<settings::Subnet> own_address(const std::string& interface);

/// A route of IPv4.
struct Route {
  std::string destination;  // "10.100.1.0/24", "0.0.0.0/0"
  std::string gateway;      // "" where it is on the link
  std::string interface;
  unsigned metric = 0;
};

/// By the text of /proc/net/route (proc_net(5)); a line that is none is left out.
std::vector<Route> routes_in(const std::string& table);
std::vector<Route> routes();

}  // namespace adit::host
