#pragma once

#include <linux/if_packet.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "loop/file_descriptor.hpp"

struct sock_filter;

namespace adit::applier {

using Mac = std::array<std::uint8_t, 6>;

/// "02:00:5e:10:00:01"
std::string text_of(const Mac& mac);

inline constexpr std::size_t kArpBytes = 28;

/// An ARP Probe (RFC 5227 2.1.1) for an address. Its sender address is 0, so that ARP caches stay unchanged.
std::array<std::uint8_t, kArpBytes> arp_probe(const Mac& own, std::uint32_t address);

/// A received ARP packet for IPv4 on Ethernet.
struct ArpPacket {
  bool asks = false;  // a request; otherwise a reply
  Mac sender{};
  std::uint32_t from = 0, about = 0;
  /// Whether the sender probes for the address before using it (RFC 5227 1.1).
  bool probes(std::uint32_t address) const { return asks && from == 0 && about == address; }
};
/// std::nullopt if the packet is not ARP for IPv4 on Ethernet.
std::optional<ArpPacket> read_arp(std::span<const std::uint8_t> packet);

/// The MAC address that claims `address` by this packet (RFC 826): it uses the address, or probes for it at
/// the same time. std::nullopt: our own packet, another address, or not ARP for IPv4 on Ethernet.
std::optional<Mac> claimant(std::span<const std::uint8_t> packet, std::uint32_t address, const Mac& own);

/// The MAC address of an interface. Error: the interface is absent or not Ethernet.
std::expected<Mac, std::string> mac_of(const std::string& interface);

/// Sends and receives ARP on one interface; needs CAP_NET_RAW.
class ArpSocket {
 public:
  /// Receives all ARP of the interface.
  static std::expected<ArpSocket, std::string> open(const std::string& interface);

  /// Makes the kernel pass only packets from these addresses and probes for them.
  std::expected<void, std::string> filter_addresses(const std::vector<std::uint32_t>& addresses);
  /// Broadcasts a request for the address.
  std::expected<void, std::string> ask(std::uint32_t address) const;
  /// Length of the next packet, or std::nullopt if there is no more. Does not block. 0: a packet for another
  /// receiver, which the kernel makes of frames of other VLANs.
  std::optional<std::size_t> receive(std::span<std::uint8_t> into) const;

  const Mac& own() const { return own_; }
  int descriptor() const { return socket_.get(); }

 private:
  loop::FileDescriptor socket_;
  sockaddr_ll everybody_{};
  std::string interface_;
  Mac own_{};
};

/// The kernel filter of filter_addresses() (socket(7), SO_ATTACH_FILTER), for data from the ARP header on.
std::vector<sock_filter> arp_filter(const std::vector<std::uint32_t>& addresses);

/// Another machine's claim to an address.
struct Claim {
  std::uint32_t address = 0;
  std::string mac;
  std::string own;  // this machine's interface with that MAC address; "": another machine
};

/// Asks on `interface` by ARP (RFC 5227 2.1.1) whether another machine has one of `addresses`. Blocks for
/// answers; needs CAP_NET_RAW. The test is shorter than the RFC's, which is for a machine about to use an
/// address, because a user waits for it. Error: the test failed.
std::expected<std::optional<Claim>, std::string> probe(const std::string& interface,
                                                       const std::vector<std::uint32_t>& addresses);

inline constexpr int kProbes = 3;
inline constexpr std::chrono::milliseconds kBetweenProbes{300}, kAfterProbes{700};

}  // namespace adit::applier
