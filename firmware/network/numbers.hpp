#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "codec/value.hpp"
#include "settings/settings.hpp"
#include "settings/subnet.hpp"

namespace adit::network {

/// What the box's two interfaces have: each an IPv4 address of its own in a subnet.
struct Numbers {
  settings::Subnet team;
  settings::Subnet command_post;
  std::optional<std::uint32_t> gateway;  // in the Command Post's subnet, to the rest of its network

  friend bool operator==(const Numbers&, const Numbers&) = default;
};

inline constexpr std::uint8_t kWidest = 8, kNarrowest = 30;  // prefixes that leave room for two hosts

/// Of `{"team": {"address", "prefix"}, "command_post": {"address", "prefix", "gateway"}}`, or all that is
/// wrong with it, each by its path: members that are missing, unknown or given twice, values of the wrong
/// kind, addresses that no host can have. `gateway` may be absent, null or "".
std::expected<Numbers, std::vector<settings::Error>> read_numbers(const codec::Value& value);

codec::Value to_json(const Numbers& numbers);

/// "192.168.7.11/24"
std::string host_text(const settings::Subnet& host);

}  // namespace adit::network
