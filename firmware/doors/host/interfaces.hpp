#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "settings/subnet.hpp"

namespace adit::host {

/// The kernel's dev_valid_name(). Such a name cannot be a path.
inline bool is_interface_name(std::string_view name) {
  return !name.empty() && name.size() <= 15 && name != "." && name != ".." &&
         name.find_first_of("/: \t\n\v\f\r") == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

/// The present state of a network interface.
struct Interface {
  std::string name;
  bool up = false;
  std::optional<bool> carrier;
  std::vector<std::string> addresses;  // "10.0.0.1/24", "fe80::1/64"
};

/// The driver's data about a port.
struct Port {
  std::string mac;               // "02:00:00:00:00:01" or ""
  std::optional<unsigned> mbit;  // of the link; nullopt: no link, or not known
  std::string duplex;            // "full", "half"; "": not known
};

/// `sys_class_net`: the kernel's list of interfaces. std::nullopt: no such interface. Error: unreadable.
std::expected<std::optional<Port>, std::string> port_in(const std::string& sys_class_net,
                                                        const std::string& interface);
std::expected<std::optional<Port>, std::string> port(const std::string& interface);

/// This machine's mDNS name: "adit.local" (RFC 6762 3).
std::string local_name();

/// All interfaces in the kernel's order. Error: "cannot read this machine's addresses: ...".
std::expected<std::vector<Interface>, std::string> interfaces();

/// All IPv4 addresses of an interface, link-local ones last (the kernel lists them first). Empty if the
/// interface does not exist. Error: as interfaces().
std::expected<std::vector<settings::Subnet>, std::string> own_addresses(const std::string& interface);

/// The first of own_addresses(), or std::nullopt.
std::expected<std::optional<settings::Subnet>, std::string> own_address(const std::string& interface);

/// An IPv4 route.
struct Route {
  std::string destination;  // "10.100.1.0/24", "0.0.0.0/0"
  std::string gateway;      // "": on the link
  std::string interface;
  unsigned metric = 0;
};

/// Parses /proc/net/route (proc_net(5)) and skips other lines.
std::vector<Route> routes_in(const std::string& table);
std::vector<Route> routes();

/// As carrier() of service.hpp. `sys_class_net`: the kernel's list of interfaces.
std::optional<bool> carrier_in(const std::string& sys_class_net, const std::string& interface);

/// A socket that becomes readable when an interface comes, goes or changes, or its cable does (rtnetlink(7),
/// RTMGRP_LINK): a plugged cable at once, a pulled one within a second. Empty if the kernel gives none.
loop::FileDescriptor link_changes();

/// The same, also for changes of IPv4 addresses (RTMGRP_IPV4_IFADDR).
loop::FileDescriptor link_and_address_changes();

/// Clears the socket. Read the interfaces afterwards. False: broken; the socket reports no more changes.
bool take_link_changes(const loop::FileDescriptor& changes);

}  // namespace adit::host
