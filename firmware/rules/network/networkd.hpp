#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "network/numbers.hpp"

namespace adit::network {

/// The routing table of the Command Post's routes. Only sockets bound to its interface or to one of its
/// addresses use it. So traffic to the team never uses these routes, even if both sides' subnets overlap.
inline constexpr int kRouteTable = 230;

/// The systemd.network(5) file of the team's side: its address, a link-local address and mDNS. DHCP sets only
/// the address: no route, name server or time.
std::string team_file(const std::string& interface, const Numbers& numbers);
/// The systemd.network(5) file of the Command Post's side: the addresses, and routes by the gateway to
/// `endpoints` outside their subnets. It has no default route, because the two networks meet only inside
/// Adit. The interface accepts no configuration from the network and sends no announcements.
std::string command_post_file(const std::string& interface, const Numbers& numbers,
                              const std::vector<std::uint32_t>& endpoints);

/// File names: the lower number wins. A change on trial precedes the stored numbers, and both precede the
/// machine's earlier files (netplan's 10-*), which may match an interface by its old name.
inline constexpr const char* kTriedTeam = "04-adit-team.network";
inline constexpr const char* kTriedCommandPost = "04-adit-command-post.network";
inline constexpr const char* kKeptTeam = "05-adit-team.network";
inline constexpr const char* kKeptCommandPost = "05-adit-command-post.network";

}  // namespace adit::network
