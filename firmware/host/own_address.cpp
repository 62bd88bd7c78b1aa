#include "host/own_address.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <bit>
#include <cstring>

#include "host/interfaces.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::host {
namespace {

std::uint32_t ipv4_in(const sockaddr& address) {
  sockaddr_in ipv4{};
  std::memcpy(&ipv4, &address, sizeof ipv4);
  return ntohl(ipv4.sin_addr.s_addr);
}

}  // namespace

std::optional<settings::Subnet> own_address(const std::string& interface) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) return std::nullopt;
  const loop::FileDescriptor fd(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq asked{};
  std::memcpy(asked.ifr_name, interface.c_str(), interface.size());
  if (!fd || ioctl(fd.get(), SIOCGIFADDR, &asked) != 0) return std::nullopt;
  settings::Subnet own{.address = ipv4_in(asked.ifr_addr), .prefix = 32};
  if (ioctl(fd.get(), SIOCGIFNETMASK, &asked) == 0) {
    own.prefix = static_cast<std::uint8_t>(std::popcount(ipv4_in(asked.ifr_netmask)));
  }
  return own;
}

std::vector<settings::Subnet> own_addresses(const std::string& interface) {
  std::vector<settings::Subnet> all;
  for (const Interface& each : interfaces().value_or(std::vector<Interface>{})) {
    if (each.name != interface) continue;
    for (const std::string& address : each.addresses) {
      if (const auto subnet = settings::parse_subnet(address)) all.push_back(*subnet);
    }
  }
  return all;
}

}  // namespace adit::host
