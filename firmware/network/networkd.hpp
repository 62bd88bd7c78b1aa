#pragma once

#include <string>

#include "network/numbers.hpp"

namespace adit::network {

/// What systemd-networkd is to read (systemd.network(5)): a static IPv4 address, nothing learned from the
/// network, nothing said to it.
std::string team_file(const std::string& interface, const Numbers& numbers);
/// The same, and by the gateway only the Command Post's nominal subnets (ICD 3), never a default route: the
/// two networks touch only inside Adit.
std::string command_post_file(const std::string& interface, const Numbers& numbers);

/// A .network file of a lower number wins over one of a higher, wherever they are; of the same name, /etc
/// would win over /run. So what is tried goes before what is kept.
inline constexpr const char* kTriedTeam = "40-adit-team.network";
inline constexpr const char* kTriedCommandPost = "40-adit-command-post.network";
inline constexpr const char* kKeptTeam = "50-adit-team.network";
inline constexpr const char* kKeptCommandPost = "50-adit-command-post.network";

}  // namespace adit::network
