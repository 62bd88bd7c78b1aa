#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

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
/// the same time. std::nullopt: the packet is our own, about another address, or not ARP for IPv4 on
/// Ethernet.
std::optional<Mac> claimant(std::span<const std::uint8_t> packet, std::uint32_t address, const Mac& own);

}  // namespace adit::applier
