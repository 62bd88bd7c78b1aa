#include "host/own_address.hpp"

#include <algorithm>

#include "host/interfaces.hpp"

namespace adit::host {
namespace {

constexpr settings::Subnet kLinkLocal{0xa9fe0000, 16};  // RFC 3927

}  // namespace

std::vector<settings::Subnet> own_addresses(const std::string& interface) {
  std::vector<settings::Subnet> all;
  for (const Interface& each : interfaces().value_or(std::vector<Interface>{})) {
    if (each.name != interface) continue;
    for (const std::string& address : each.addresses) {
      if (const auto subnet = settings::parse_subnet(address)) all.push_back(*subnet);
    }
  }
  std::ranges::stable_partition(
      all, [](const settings::Subnet& each) { return !kLinkLocal.contains(each.address); });
  return all;
}

std::optional<settings::Subnet> own_address(const std::string& interface) {
  const auto all = own_addresses(interface);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

}  // namespace adit::host
