#include "applier/arp_probe.hpp"

#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "applier/arp.hpp"
#include "host/files.hpp"
#include "host/service.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::applier {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint16_t kArpInNetworkOrder = __builtin_bswap16(ETH_P_ARP);

std::unexpected<std::string> failed(const std::string& interface, const char* doing) {
  return std::unexpected(interface + ": " + doing + ": " + std::strerror(errno));
}

/// A socket for ARP on one interface, and where the interface is.
struct Listener {
  loop::FileDescriptor socket;
  sockaddr_ll everybody{};
  Mac own{};
};

std::expected<Listener, std::string> listen_on(const std::string& interface) {
  Listener listener;
  listener.socket = loop::FileDescriptor(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, kArpInNetworkOrder));
  if (!listener.socket) return failed(interface, "opening a socket for ARP");
  ifreq asked{};
  interface.copy(asked.ifr_name, IFNAMSIZ - 1);
  if (ioctl(listener.socket.get(), SIOCGIFHWADDR, &asked) != 0)
    return failed(interface, "asking for its MAC address");
  if (asked.ifr_hwaddr.sa_family != ARPHRD_ETHER) return std::unexpected(interface + ": is no Ethernet");
  std::memcpy(listener.own.data(), asked.ifr_hwaddr.sa_data, listener.own.size());
  sockaddr_ll place{};
  place.sll_family = AF_PACKET;
  place.sll_protocol = kArpInNetworkOrder;
  place.sll_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (bind(listener.socket.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    return failed(interface, "binding to it");
  }
  listener.everybody = place;
  listener.everybody.sll_halen = ETH_ALEN;
  std::memset(listener.everybody.sll_addr, 0xff, ETH_ALEN);
  return listener;
}

/// The interface of this machine that has the MAC address, or "".
std::string own_interface(const std::string& mac) {
  const std::string folder = "/sys/class/net";
  for (const std::string& name : host::names_in(folder).value_or(std::vector<std::string>())) {
    const auto file = host::slurp(folder + '/' + name + "/address");
    if (file && file->text.starts_with(mac)) return name;
  }
  return "";
}

using Addresses = std::vector<std::uint32_t>;

/// The first claim that is heard by then.
std::optional<Claim> hear(const Listener& listener, const Addresses& addresses, Clock::time_point until) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd ready{listener.socket.get(), POLLIN, 0};
    if (left <= 0 || poll(&ready, 1, static_cast<int>(left)) <= 0) {
      if (left > 0 && errno == EINTR) continue;
      return std::nullopt;
    }
    std::uint8_t packet[128];
    const ssize_t size = recv(listener.socket.get(), packet, sizeof packet, MSG_DONTWAIT);
    if (size <= 0) continue;
    for (const std::uint32_t address : addresses) {
      const auto mac = claimant({packet, static_cast<std::size_t>(size)}, address, listener.own);
      if (mac) return Claim{.address = address, .mac = text_of(*mac), .own = own_interface(text_of(*mac))};
    }
  }
}

}  // namespace

std::expected<std::optional<Claim>, std::string> probe(const std::string& interface,
                                                       const Addresses& addresses) {
  const auto listener = listen_on(interface);
  if (!listener) return std::unexpected(listener.error());
  for (int i = 0; i < kProbes; ++i) {
    for (const std::uint32_t address : addresses) {
      const auto packet = arp_probe(listener->own, address);
      if (sendto(listener->socket.get(), packet.data(), packet.size(), 0,
                 reinterpret_cast<const sockaddr*>(&listener->everybody), sizeof listener->everybody) < 0) {
        return failed(interface, "asking by ARP");
      }
    }
    const auto wait = i + 1 < kProbes ? kBetweenProbes : kAfterProbes;
    if (auto claim = hear(*listener, addresses, Clock::now() + wait)) return claim;
  }
  return std::nullopt;
}

}  // namespace adit::applier
