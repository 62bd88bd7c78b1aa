#include "applier/arp.hpp"

#include <linux/filter.h>
#include <linux/if_ether.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>

#include "host/files.hpp"
#include "host/service.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::applier {
namespace {

// RFC 826: hardware 1 (Ethernet), protocol 0x0800 (IPv4), lengths 6 and 4, then the operation.
constexpr std::array<std::uint8_t, 6> kEthernetIpv4 = {0, 1, 8, 0, 6, 4};
constexpr std::uint8_t kRequest = 1, kReply = 2;
constexpr std::size_t kOperation = 7, kSender = 8, kSenderAddress = 14, kTargetAddress = 24;

void put(std::span<std::uint8_t> at, std::uint32_t address) {
  for (std::size_t i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(address >> (24 - 8 * i));
}

std::uint32_t get(std::span<const std::uint8_t> at) {
  return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 | at[3];
}

}  // namespace

std::string text_of(const Mac& mac) {
  std::string text;
  for (const std::uint8_t byte : mac) text.append(text.empty() ? "" : ":").append(icd::hex(byte));
  return text;
}

std::array<std::uint8_t, kArpBytes> arp_probe(const Mac& own, std::uint32_t address) {
  std::array<std::uint8_t, kArpBytes> packet{};
  std::ranges::copy(kEthernetIpv4, packet.begin());
  packet[kOperation] = kRequest;
  std::ranges::copy(own, packet.begin() + kSender);
  put(std::span(packet).subspan(kTargetAddress), address);
  return packet;
}

std::optional<ArpPacket> read_arp(std::span<const std::uint8_t> packet) {
  if (packet.size() < kArpBytes || !std::ranges::equal(packet.first(kEthernetIpv4.size()), kEthernetIpv4)) {
    return std::nullopt;
  }
  if (packet[kOperation - 1] != 0 || (packet[kOperation] != kRequest && packet[kOperation] != kReply))
    return std::nullopt;
  ArpPacket read{.asks = packet[kOperation] == kRequest,
                 .from = get(packet.subspan(kSenderAddress)),
                 .about = get(packet.subspan(kTargetAddress))};
  std::ranges::copy(packet.subspan(kSender, read.sender.size()), read.sender.begin());
  return read;
}

std::optional<Mac> claimant(std::span<const std::uint8_t> packet, std::uint32_t address, const Mac& own) {
  const auto read = read_arp(packet);
  if (!read || (read->from != address && !read->probes(address)) || read->sender == own) return std::nullopt;
  return read->sender;
}

namespace {

constexpr std::uint16_t kArpInNetworkOrder = __builtin_bswap16(ETH_P_ARP);
/// Limit set by the length of BPF jumps.
constexpr std::size_t kMostFiltered = 64;

std::unexpected<std::string> arp_error(const std::string& interface, const char* doing) {
  return std::unexpected(interface + ": " + doing + ": " + std::strerror(errno));
}

constexpr sock_filter statement(unsigned code, std::uint32_t value) {
  return {static_cast<std::uint16_t>(code), 0, 0, value};
}
constexpr sock_filter load(unsigned size, std::uint32_t at) {
  return statement(BPF_LD | size | BPF_ABS, at);
}

/// A comparison. One result continues the program; the other jumps to an end that keeps or drops the packet.
struct Jump {
  unsigned how;
  std::uint32_t value;
  bool ends_where_true, keeps;
};

}  // namespace

std::vector<sock_filter> arp_filter(const std::vector<std::uint32_t>& addresses) {
  assert(addresses.size() <= kMostFiltered);
  std::vector<sock_filter> program;
  std::vector<std::pair<std::size_t, Jump>> jumps;
  const auto jump = [&](Jump how) {
    jumps.emplace_back(program.size(), how);
    program.push_back(statement(BPF_JMP | how.how | BPF_K, how.value));
  };
  program.push_back(load(BPF_W, 0));
  jump({BPF_JEQ, 0x00010800, false, false});  // Ethernet, IPv4
  program.push_back(load(BPF_H, 4));
  jump({BPF_JEQ, 0x0604, false, false});  // address lengths
  program.push_back(load(BPF_W, 14));     // sender's address
  for (const std::uint32_t each : addresses) jump({BPF_JEQ, each, true, true});
  jump({BPF_JEQ, 0, false, false});
  program.push_back(load(BPF_W, 24));  // target address
  for (const std::uint32_t each : addresses) jump({BPF_JEQ, each, true, true});
  const std::size_t drop = program.size(), keep = drop + 1;
  program.push_back(statement(BPF_RET | BPF_K, 0));
  program.push_back(statement(BPF_RET | BPF_K, kArpBytes));
  for (const auto& [at, how] : jumps) {
    const auto distance = static_cast<std::uint8_t>((how.keeps ? keep : drop) - at - 1);
    (how.ends_where_true ? program[at].jt : program[at].jf) = distance;
  }
  return program;
}

std::expected<Mac, std::string> mac_of(const std::string& interface) {
  const loop::FileDescriptor any(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq asked{};
  interface.copy(asked.ifr_name, IFNAMSIZ - 1);
  if (ioctl(any.get(), SIOCGIFHWADDR, &asked) != 0) return arp_error(interface, "reading its MAC address");
  if (asked.ifr_hwaddr.sa_family != ARPHRD_ETHER)
    return std::unexpected(interface + ": expected an Ethernet interface");
  Mac mac{};
  std::memcpy(mac.data(), asked.ifr_hwaddr.sa_data, mac.size());
  return mac;
}

std::expected<ArpSocket, std::string> ArpSocket::open(const std::string& interface) {
  ArpSocket arp;
  arp.interface_ = interface;
  arp.socket_ = loop::FileDescriptor(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!arp.socket_) return arp_error(interface, "opening a socket for ARP");
  auto mac = ADIT_TRY(mac_of(interface));
  arp.own_ = mac;
  sockaddr_ll place{};
  place.sll_family = AF_PACKET;
  place.sll_protocol = kArpInNetworkOrder;
  place.sll_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (bind(arp.socket_.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    return arp_error(interface, "binding a socket to it");
  }
  arp.everybody_ = place;
  arp.everybody_.sll_halen = ETH_ALEN;
  std::memset(arp.everybody_.sll_addr, 0xff, ETH_ALEN);
  return arp;
}

std::expected<void, std::string> ArpSocket::filter_addresses(const std::vector<std::uint32_t>& addresses) {
  auto program = arp_filter(addresses);
  const sock_fprog set{static_cast<std::uint16_t>(program.size()), program.data()};
  if (setsockopt(socket_.get(), SOL_SOCKET, SO_ATTACH_FILTER, &set, sizeof set) != 0)
    return arp_error(interface_, "setting the socket's filter");
  return {};
}

std::expected<void, std::string> ArpSocket::ask(std::uint32_t address) const {
  const auto packet = arp_probe(own_, address);
  if (sendto(socket_.get(), packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&everybody_),
             sizeof everybody_) < 0) {
    return arp_error(interface_, "sending an ARP request");
  }
  return {};
}

std::optional<std::size_t> ArpSocket::receive(std::span<std::uint8_t> into) const {
  sockaddr_ll from{};
  socklen_t length = sizeof from;
  const ssize_t size = recvfrom(socket_.get(), into.data(), into.size(), MSG_DONTWAIT,
                                reinterpret_cast<sockaddr*>(&from), &length);
  if (size < 0) return std::nullopt;
  const bool is_for_us = from.sll_pkttype == PACKET_HOST || from.sll_pkttype == PACKET_BROADCAST ||
                         from.sll_pkttype == PACKET_MULTICAST;
  return is_for_us ? static_cast<std::size_t>(size) : 0;
}

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
std::optional<Claim> receive_claim(const ArpSocket& arp, const Addresses& addresses,
                                   Clock::time_point until) {
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
    if (auto claim = receive_claim(arp, addresses, Clock::now() + wait)) return claim;
  }
  return std::nullopt;
}

}  // namespace adit::applier
