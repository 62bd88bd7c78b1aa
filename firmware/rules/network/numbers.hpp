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

/// Source of team0's address. team0 always has a link-local address (RFC 3927) in addition.
enum class Mode : std::uint8_t { Static, Dhcp, LinkLocal };
/// In the order of Mode.
inline constexpr std::string_view kModeWords[] = {"static", "dhcp", "link-local"};
constexpr auto& words_of(Mode /*of*/) {
  return kModeWords;
}
constexpr std::string_view name_of(Mode mode) {
  return kModeWords[static_cast<std::size_t>(mode)];
}

inline constexpr std::size_t kMostAddresses = 8;  // of the Command Post's side

/// The IPv4 addresses and subnets of the box's two interfaces.
struct Numbers {
  Mode mode = Mode::Static;                         // of the team's side
  settings::Subnet team = {};                       // for Mode::Static
  std::vector<settings::Subnet> command_post = {};  // at most kMostAddresses; may be empty
  std::optional<std::uint32_t> gateway = {};        // in one of these subnets; leads to endpoints elsewhere

  static const codec::Row kRow;  // the stored form
  friend bool operator==(const Numbers&, const Numbers&) = default;
};

inline constexpr std::uint8_t kWidest = 8, kNarrowest = 30;  // prefixes with room for two hosts

/// Reads `{"team": {"mode", "address", "prefix"}, "command_post": {"addresses": [{"address", "prefix"}, ...],
/// "gateway"}}`. The error lists all faults by path: missing, unknown or repeated members, wrong types,
/// addresses that a host cannot have, repeated addresses. `mode` defaults to static; the other modes have no
/// address. `gateway` may be absent, null or "". `{"address", "prefix", "gateway"}` may replace `addresses`.
std::expected<Numbers, std::vector<settings::Error>> read_numbers(const codec::Value& value);

/// A host's address with its prefix, in the stored form.
extern const codec::Row kHost;
/// Kinds of an address as text. "" stands for no address.
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

/// The Command Post address of the box whose subnet contains `address`, or null.
const settings::Subnet* on_link(const Numbers& numbers, std::uint32_t address);
/// The host to send to for a Command Post's address: itself or the gateway. std::nullopt: no route.
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
struct KindOf<settings::Subnet> : KindOfRow<settings::Subnet, network::kHost> {};

template <>
struct KindOf<network::Numbers> {
  static Value write(const network::Numbers& numbers) { return write_row(network::Numbers::kRow, &numbers); }
  static void read(const Field& field, network::Numbers& numbers);  // as read_numbers() does
  static constexpr Schema schema = {.row = &network::Numbers::kRow, .has_reader = true};
};

}  // namespace adit::codec
