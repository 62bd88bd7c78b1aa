#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row.hpp"
#include "settings/settings.hpp"
#include "settings/subnet.hpp"

namespace adit::network {

/// How team0 comes by its address. Besides, it always has a link-local one (RFC 3927).
enum class Mode : std::uint8_t { Static, Dhcp, LinkLocal };
/// In their order.
inline constexpr std::string_view kModeWords[] = {"static", "dhcp", "link-local"};
constexpr std::string_view name_of(Mode mode) {
  return kModeWords[static_cast<std::size_t>(mode)];
}

inline constexpr std::size_t kMostAddresses = 8;  // of the Command Post's side

/// What the box's two interfaces have: IPv4 addresses of their own, each in a subnet.
struct Numbers {
  Mode mode = Mode::Static;                         // of the team's side
  settings::Subnet team = {};                       // of Mode::Static
  std::vector<settings::Subnet> command_post = {};  // kMostAddresses; none: the interface has none
  std::optional<std::uint32_t> gateway = {};        // in one of these subnets, to endpoints elsewhere

  static const codec::Row kRow;  // as it is written
  friend bool operator==(const Numbers&, const Numbers&) = default;
};

inline constexpr std::uint8_t kWidest = 8, kNarrowest = 30;  // prefixes that leave room for two hosts

/// Of `{"team": {"mode", "address", "prefix"}, "command_post": {"addresses": [{"address", "prefix"}, ...],
/// "gateway"}}`, or all that is wrong with it, each by its path: members that are missing, unknown or given
/// twice, values of the wrong kind, addresses that no host can have, or that are given twice. `mode` may be
/// absent: static; the other modes have no address. `gateway` may be absent, null or "". One address may
/// stand in place of `addresses`: `{"address", "prefix", "gateway"}`.
std::expected<Numbers, std::vector<settings::Error>> read_numbers(const codec::Value& value);

/// A host's own address with its prefix, as it is written.
extern const codec::Row kHost;
/// Kinds of an address: as text, and "" where there is none.
struct AddressText {
  static codec::Value write(std::uint32_t address) { return {settings::ipv4_text(address)}; }
  static void read(const codec::Field& field, std::uint32_t& address);
  static constexpr codec::Schema schema = {.type = "string"};
};
struct AddressOrNone {
  static codec::Value write(const std::optional<std::uint32_t>& address) {
    return {address ? settings::ipv4_text(*address) : ""};
  }
  static void read(const codec::Field& field, std::optional<std::uint32_t>& address);
  static constexpr codec::Schema schema = {.type = "string"};
};

/// Of the Command Post's addresses, the one in whose subnet `address` is.
const settings::Subnet* on_link(const Numbers& numbers, std::uint32_t address);
/// Who answers there for an address of the Command Post's: it, or the gateway to it; nothing: there is no
/// way.
std::optional<std::uint32_t> next_hop(const Numbers& numbers, std::uint32_t address);

/// "192.168.7.11/24", "dhcp", "link-local"
std::string team_text(const Numbers& numbers);
/// "10.100.1.10/24, 10.100.2.10/24", or "none"
std::string command_post_text(const Numbers& numbers);
/// "192.168.7.11/24"
std::string host_text(const settings::Subnet& host);

}  // namespace adit::network

namespace adit::codec {

template <>
struct KindOf<network::Mode> : KindOfWords<network::Mode, network::kModeWords> {};

template <>
struct KindOf<settings::Subnet> : KindOfRow<settings::Subnet, network::kHost> {};

template <>
struct KindOf<network::Numbers> {
  static Value write(const network::Numbers& numbers) { return write_row(network::Numbers::kRow, &numbers); }
  static void read(const Field& field, network::Numbers& numbers);  // as read_numbers()
  static constexpr Schema schema = {.row = &network::Numbers::kRow, .has_reader = true};
};

}  // namespace adit::codec
