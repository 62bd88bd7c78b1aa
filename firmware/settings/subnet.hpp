#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace adit::settings {

/// An IPv4 subnet (RFC 4632).
struct Subnet {
  std::uint32_t address = 0;  // of the subnet itself, in the host's order of bytes
  std::uint32_t prefix = 32;

  bool contains(std::uint32_t host) const;
  bool overlaps(const Subnet& other) const;
  /// "10.100.0.0/16"
  std::string text() const;
};

/// Nothing where `text` is no IPv4 address.
std::optional<std::uint32_t> ipv4(const std::string& text);

/// The subnet that `address` is in. Nothing where that is no IPv4 address.
std::optional<Subnet> subnet_of(const std::string& address, std::uint32_t prefix);

}  // namespace adit::settings
