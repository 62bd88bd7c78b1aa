#include "settings/subnet.hpp"

#include <algorithm>
#include <charconv>

namespace adit::settings {
namespace {

constexpr Subnet kCommandPost[] = {{0x0a010100, 24}, {0x0a020100, 24}, {0x0a640000, 16}};

/// All of `text` as a decimal number of at most `most`, without leading zeros: inet_aton() would read these
/// as octal.
std::optional<std::uint32_t> decimal(std::string_view text, std::uint32_t most) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number > most) return std::nullopt;
  if (text.size() > 1 && text.front() == '0') return std::nullopt;
  return number;
}

}  // namespace

std::optional<std::uint32_t> ipv4_of(std::string_view text) {
  std::uint32_t address = 0;
  for (int part = 0; part < 4; ++part) {
    const auto dot = part < 3 ? text.find('.') : text.size();
    if (dot == std::string_view::npos) return std::nullopt;
    const auto byte = decimal(text.substr(0, dot), 255);
    if (!byte) return std::nullopt;
    address = address << 8 | *byte;
    text.remove_prefix(std::min(dot + 1, text.size()));
  }
  return address;
}

std::string ipv4_text(std::uint32_t address) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    text += std::to_string(address >> shift & 255);
    if (shift > 0) text += '.';
  }
  return text;
}

std::expected<Subnet, std::string> parse_subnet(std::string_view text) {
  const auto slash = text.find('/');
  const auto address = ipv4_of(text.substr(0, slash));
  const auto prefix = slash == std::string_view::npos ? std::nullopt : decimal(text.substr(slash + 1), 32);
  if (!address || !prefix) return std::unexpected("expected an IPv4 subnet such as 10.1.1.0/24");
  return Subnet{*address, static_cast<std::uint8_t>(*prefix)};
}

std::string written(const Subnet& subnet) {
  return ipv4_text(subnet.first()) + '/' + std::to_string(subnet.prefix);
}

bool overlaps(const Subnet& a, const Subnet& b) {
  return a.prefix <= b.prefix ? a.contains(b.address) : b.contains(a.address);
}

std::span<const Subnet> command_post_subnets() {
  return kCommandPost;
}

}  // namespace adit::settings
