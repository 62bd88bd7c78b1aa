#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "network/numbers.hpp"

namespace adit::network {

/// The Command Post's routes have a table of their own, in which nobody looks but who is bound to its
/// interface, or to an address of it: where both sides' subnets overlap, what goes to the team never finds
/// them.
inline constexpr int kRouteTable = 230;

/// What systemd-networkd is to read (systemd.network(5)). The team's side: its address, a link-local one
/// besides, and mDNS. By DHCP an address is taken, and nothing else: no route, no name server, no time.
std::string team_file(const std::string& interface, const Numbers& numbers);
/// The Command Post's side: addresses, and by the gateway those of `endpoints` that are in no subnet of them,
/// never a default route: the two networks touch only inside Adit. Nothing is learned from the network, and
/// nothing said to it.
std::string command_post_file(const std::string& interface, const Numbers& numbers,
                              const std::vector<std::uint32_t>& endpoints);

/// A .network file of a lower number wins over one of a higher: what is tried goes before what is kept, and
/// both before what the machine may have of before (netplan's 10-*), for an interface is found by its earlier
/// name, too.
inline constexpr const char* kTriedTeam = "04-adit-team.network";
inline constexpr const char* kTriedCommandPost = "04-adit-command-post.network";
inline constexpr const char* kKeptTeam = "05-adit-team.network";
inline constexpr const char* kKeptCommandPost = "05-adit-command-post.network";

}  // namespace adit::network
