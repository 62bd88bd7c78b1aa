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

/// An ARP Probe (RFC 5227 2.1.1): who has this address? From nobody's address, so that no cache is spoilt.
std::array<std::uint8_t, kArpBytes> arp_probe(const Mac& own, std::uint32_t address);

/// A packet of ARP for IPv4 on Ethernet, as it is received.
struct ArpPacket {
  bool asks = false;  // it is a request; else a reply
  Mac sender{};
  std::uint32_t from = 0, about = 0;
  /// Asks whether it could have the address (RFC 5227 1.1), which it does not use yet.
  bool probes(std::uint32_t address) const { return asks && from == 0 && about == address; }
};
/// Nothing where it is no such packet.
std::optional<ArpPacket> read_arp(std::span<const std::uint8_t> packet);

/// Who claims `address` by this packet of ARP (RFC 826, for IPv4 on Ethernet): says that it has it, or probes
/// for it at the same time. Nothing where it is one's own, is about another, or is no such packet.
std::optional<Mac> claimant(std::span<const std::uint8_t> packet, std::uint32_t address, const Mac& own);

}  // namespace adit::applier
