#include "applier/arp_probe.hpp"

#include <poll.h>

#include <cerrno>

#include "applier/arp_socket.hpp"
#include "host/files.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"

namespace adit::applier {
namespace {

using Clock = std::chrono::steady_clock;

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

/// The first claim before `until`.
std::optional<Claim> hear(const ArpSocket& arp, const Addresses& addresses, Clock::time_point until) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd ready{arp.descriptor(), POLLIN, 0};
    if (left <= 0 || poll(&ready, 1, static_cast<int>(left)) <= 0) {
      if (left > 0 && errno == EINTR) continue;
      return std::nullopt;
    }
    std::uint8_t packet[128];
    const auto size = arp.receive(packet);
    if (!size) continue;
    for (const std::uint32_t address : addresses) {
      const auto mac = claimant({packet, *size}, address, arp.own());
      if (mac) return Claim{.address = address, .mac = text_of(*mac), .own = own_interface(text_of(*mac))};
    }
  }
}

}  // namespace

std::expected<std::optional<Claim>, std::string> probe(const std::string& interface,
                                                       const Addresses& addresses) {
  const auto arp = ADIT_TRY(ArpSocket::open(interface));
  for (int i = 0; i < kProbes; ++i) {
    for (const std::uint32_t address : addresses) {
      ADIT_TRY(arp.ask(address));
    }
    const auto wait = i + 1 < kProbes ? kBetweenProbes : kAfterProbes;
    if (auto claim = hear(arp, addresses, Clock::now() + wait)) return claim;
  }
  return std::nullopt;
}

}  // namespace adit::applier
