#include "settings/subnet.hpp"

#include <arpa/inet.h>

#include <algorithm>

#include "icd/sentence.hpp"

namespace adit::settings {
namespace {

std::uint32_t mask(std::uint32_t prefix) {
  return prefix == 0 ? 0 : ~std::uint32_t{0} << (32 - prefix);
}

}  // namespace

bool Subnet::contains(std::uint32_t host) const {
  return (host & mask(prefix)) == address;
}

bool Subnet::overlaps(const Subnet& other) const {
  const std::uint32_t wider = mask(std::min(prefix, other.prefix));
  return (address & wider) == (other.address & wider);
}

std::string Subnet::text() const {
  return icd::sentence(address >> 24, ".", address >> 16 & 255, ".", address >> 8 & 255, ".", address & 255,
                       "/", prefix);
}

std::optional<std::uint32_t> ipv4(const std::string& text) {
  in_addr parsed{};
  if (inet_pton(AF_INET, text.c_str(), &parsed) != 1) return std::nullopt;
  return ntohl(parsed.s_addr);
}

std::optional<Subnet> subnet_of(const std::string& address, std::uint32_t prefix) {
  const auto host = ipv4(address);
  if (!host) return std::nullopt;
  return Subnet{*host & mask(prefix), prefix};
}

}  // namespace adit::settings
