#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace adit::settings {

/// An IPv4 address as a number: 10.0.0.1 is 0x0a000001.
std::optional<std::uint32_t> ipv4_of(std::string_view text);
std::string ipv4_text(std::uint32_t address);

/// An IPv4 address with a prefix length: a host's address, or a whole subnet.
struct Subnet {
  std::uint32_t address = 0;
  std::uint8_t prefix = 0;  // 0 to 32

  std::uint32_t mask() const { return prefix == 0 ? 0 : ~std::uint32_t{0} << (32 - prefix); }
  std::uint32_t first() const { return address & mask(); }  // network address
  std::uint32_t last() const { return first() | ~mask(); }  // broadcast address
  bool contains(std::uint32_t other) const { return (other & mask()) == first(); }
  friend bool operator==(const Subnet&, const Subnet&) = default;
};

/// "10.1.1.0/24"; any address of the subnet is accepted.
std::expected<Subnet, std::string> parse_subnet(std::string_view text);
/// The subnet without the host: "10.1.1.0/24".
std::string to_text(const Subnet& subnet);

bool overlaps(const Subnet& a, const Subnet& b);

/// The Command Post's nominal subnets, to be avoided (ICD 3): 10.1.1.0/24, 10.2.1.0/24, 10.100.0.0/16.
std::span<const Subnet> command_post_subnets();

}  // namespace adit::settings
