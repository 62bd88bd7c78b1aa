#include "settings/subnet.hpp"

#include <arpa/inet.h>

#include "icd/text.hpp"

namespace adit::settings {
namespace {

constexpr Subnet kCommandPost[] = {{0x0a010100, 24}, {0x0a020100, 24}, {0x0a640000, 16}};

/// 0 to 32, without leading zeros.
std::optional<std::uint8_t> prefix_in(std::string_view text) {
  const auto number = icd::number_in<std::uint8_t>(text);
  const bool has_zeros = text.size() > 1 && text.front() == '0';
  return number && *number <= 32 && !has_zeros ? number : std::nullopt;
}

}  // namespace

/// Rejects leading zeros, which inet_aton() reads as octal, and short forms such as "10.1".
std::optional<std::uint32_t> ipv4_of(std::string_view text) {
  in_addr address{};
  if (text.contains('\0') || inet_pton(AF_INET, std::string(text).c_str(), &address) != 1)
    return std::nullopt;
  return ntohl(address.s_addr);
}

std::string ipv4_text(std::uint32_t address) {
  char text[INET_ADDRSTRLEN];
  const in_addr in_order{htonl(address)};
  return inet_ntop(AF_INET, &in_order, text, sizeof text);
}

std::expected<Subnet, std::string> parse_subnet(std::string_view text) {
  const auto slash = text.find('/');
  const auto address = ipv4_of(text.substr(0, slash));
  const auto prefix = slash == std::string_view::npos ? std::nullopt : prefix_in(text.substr(slash + 1));
  if (!address || !prefix) return std::unexpected("expected an IPv4 subnet such as 10.1.1.0/24");
  return Subnet{*address, *prefix};
}

std::string to_text(const Subnet& subnet) {
  return ipv4_text(subnet.first()) + '/' + std::to_string(subnet.prefix);
}

bool overlaps(const Subnet& a, const Subnet& b) {
  return a.prefix <= b.prefix ? a.contains(b.address) : b.contains(a.address);
}

std::span<const Subnet> command_post_subnets() {
  return kCommandPost;
}

}  // namespace adit::settings
