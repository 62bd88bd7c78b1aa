#include "applier/arp.hpp"

#include <algorithm>

#include "icd/hex.hpp"

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

}  // namespace adit::applier
