#include "applier/arp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace adit::applier {
namespace {

constexpr Mac kOurMac = {2, 0, 0, 0, 0, 1}, kOther = {2, 0, 0, 0, 0, 2};
constexpr std::uint32_t kOurAddress = 0x0a64010a, kTheirAddress = 0x0a64010b;

std::vector<std::uint8_t> packet(std::uint8_t operation, const Mac& sender, std::uint32_t from,
                                 std::uint32_t about) {
  std::vector<std::uint8_t> bytes(28);
  const std::array<std::uint8_t, 8> head = {0, 1, 8, 0, 6, 4, 0, operation};
  std::ranges::copy(head, bytes.begin());
  std::ranges::copy(sender, bytes.begin() + 8);
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[14 + i] = static_cast<std::uint8_t>(from >> (24 - 8 * i));
    bytes[24 + i] = static_cast<std::uint8_t>(about >> (24 - 8 * i));
  }
  return bytes;
}

TEST(ArpProbe, HasNoSenderAddress) {
  const auto probe = arp_probe(kOurMac, kOurAddress);
  EXPECT_EQ(std::vector(probe.begin(), probe.end()), packet(1, kOurMac, 0, kOurAddress));
}

TEST(AddressClaim, IsAnyPacketFromTheAddress) {
  EXPECT_EQ(claimant(packet(2, kOther, kOurAddress, kTheirAddress), kOurAddress, kOurMac), kOther)
      << "a reply";
  EXPECT_EQ(claimant(packet(1, kOther, kOurAddress, kTheirAddress), kOurAddress, kOurMac), kOther)
      << "a request";
  EXPECT_EQ(claimant(packet(1, kOther, kOurAddress, kOurAddress), kOurAddress, kOurMac), kOther)
      << "an announcement";
  EXPECT_EQ(claimant(packet(1, kOther, 0, kOurAddress), kOurAddress, kOurMac), kOther)
      << "a probe at the same time";
}

TEST(AddressClaim, IsNoOtherPacket) {
  EXPECT_EQ(claimant(packet(1, kOurMac, 0, kOurAddress), kOurAddress, kOurMac), std::nullopt)
      << "our own packet";
  EXPECT_EQ(claimant(packet(2, kOurMac, kOurAddress, kTheirAddress), kOurAddress, kOurMac), std::nullopt);
  EXPECT_EQ(claimant(packet(1, kOther, kTheirAddress, kOurAddress), kOurAddress, kOurMac), std::nullopt)
      << "somebody asks for it";
  EXPECT_EQ(claimant(packet(2, kOther, kTheirAddress, kOurAddress), kOurAddress, kOurMac), std::nullopt);
  EXPECT_EQ(claimant(packet(1, kOther, 0, kTheirAddress), kOurAddress, kOurMac), std::nullopt);
  EXPECT_EQ(claimant(packet(3, kOther, kOurAddress, kTheirAddress), kOurAddress, kOurMac), std::nullopt)
      << "of another operation";
  for (const std::size_t byte : {0u, 1u, 2u, 4u, 5u, 6u}) {
    auto bad = packet(2, kOther, kOurAddress, kTheirAddress);
    bad[byte] ^= 0x40;
    EXPECT_EQ(claimant(bad, kOurAddress, kOurMac), std::nullopt) << byte;
  }
  auto good = packet(2, kOther, kOurAddress, kTheirAddress);
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_EQ(claimant(std::span(good).first(size), kOurAddress, kOurMac), std::nullopt) << size;
  }
  good.resize(46);  // Ethernet's padding
  EXPECT_EQ(claimant(good, kOurAddress, kOurMac), kOther);
  EXPECT_EQ(text_of(kOther), "02:00:00:00:00:02");
}

}  // namespace
}  // namespace adit::applier
