#include "applier/conflict_detector.hpp"

#include <gmock/gmock.h>
#include <linux/filter.h>
#include <sys/socket.h>

#include <array>
#include <numeric>

#include "applier/arp.hpp"
#include "loop/file_descriptor.hpp"
#include "network/messages.hpp"

namespace adit::applier {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr Mac kOwn = {2, 0, 0, 0, 0, 1}, kOwnOther = {2, 0, 0, 0, 0, 2};
constexpr Mac kFirst = {2, 0, 0, 0, 0, 7}, kSecond = {2, 0, 0, 0, 0, 8};
constexpr std::uint32_t kAddress = 0x0a000001, kAnother = 0x0a000002, kElsewhere = 0x0a000063;
constexpr bool kAsks = true, kAnswers = false;

using Bytes = std::vector<std::uint8_t>;

/// An ARP packet as received, after Ethernet's header.
Bytes packet(bool asks, const Mac& sender, std::uint32_t from, std::uint32_t about) {
  Bytes bytes = {0, 1, 8, 0, 6, 4, 0, static_cast<std::uint8_t>(asks ? 1 : 2)};
  const auto put = [&bytes](std::uint32_t address) {
    for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(address >> shift));
  };
  bytes.insert(bytes.end(), sender.begin(), sender.end());
  put(from);
  bytes.insert(bytes.end(), 6, 0);
  put(about);
  return bytes;
}

class AddressConflictsTest : public testing::Test {
 protected:
  AddressConflictsTest() {
    takers.set_own({kAddress, kAnother}, {kOwn, kOwnOther}, now);
    takers.pop_due(now);
    for (const seconds gap : ConflictDetector::kFirstGaps) takers.pop_due(now += gap);
    now += ConflictDetector::kBetween;
  }

  void receive(const Bytes& bytes) {
    if (const auto read = read_arp(bytes)) takers.on_packet(*read, now);
  }
  /// Address and MAC address of each conflict.
  std::vector<std::pair<std::uint32_t, Mac>> taken() const {
    std::vector<std::pair<std::uint32_t, Mac>> all;
    for (const ConflictDetector::Conflict& each : takers.conflicts()) all.emplace_back(each.address, each.by);
    return all;
  }

  ConflictDetector::Instant now{std::chrono::hours(1)};
  ConflictDetector takers;
};

TEST_F(AddressConflictsTest, AreOtherMachinesThatUseTheAddress) {
  const std::pair<const char*, Bytes> cases[] = {
      {"an answer", packet(kAnswers, kFirst, kAddress, kElsewhere)},
      {"a question", packet(kAsks, kFirst, kAddress, kElsewhere)},
      {"an announcement", packet(kAsks, kFirst, kAddress, kAddress)},
      {"an announcement that is an answer", packet(kAnswers, kFirst, kAddress, kAddress)},
  };
  for (const auto& [what, bytes] : cases) {
    receive(bytes);
    EXPECT_THAT(taken(), ElementsAre(std::pair(kAddress, kFirst))) << what;
    now += network::kTakenFor;
    takers.pop_due(now);
    EXPECT_THAT(taken(), IsEmpty()) << what;
  }
}

TEST_F(AddressConflictsTest, AreNoOtherMachines) {
  Bytes tagged = packet(kAnswers, kFirst, kAddress, kElsewhere);
  tagged.insert(tagged.begin(), {0x81, 0, 0, 5});
  Bytes no_arp(46, 0);
  const std::pair<const char*, Bytes> cases[] = {
      {"ourselves", packet(kAnswers, kOwn, kAddress, kElsewhere)},
      {"our other interface, by the same switch", packet(kAsks, kOwnOther, kAddress, kElsewhere)},
      {"who asks us", packet(kAsks, kFirst, kElsewhere, kAddress)},
      {"who answers us", packet(kAnswers, kFirst, kElsewhere, kAddress)},
      {"who asks whether it is free", packet(kAsks, kFirst, 0, kAddress)},
      {"somebody else", packet(kAsks, kFirst, kElsewhere, kElsewhere)},
      {"an answer from nobody", packet(kAnswers, kFirst, 0, kAddress)},
      {"behind the tag of a VLAN", tagged},
      {"no ARP", no_arp},
  };
  for (const auto& [what, bytes] : cases) {
    receive(bytes);
    EXPECT_THAT(taken(), IsEmpty()) << what;
  }
  const Bytes whole = packet(kAnswers, kFirst, kAddress, kElsewhere);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    receive(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    EXPECT_THAT(taken(), IsEmpty()) << size;
  }
}

TEST_F(AddressConflictsTest, NameTheFirstOfSeveralWhileItIsHeard) {
  receive(packet(kAnswers, kFirst, kAddress, kElsewhere));
  for (seconds waited(0); waited < network::kTakenFor; waited += seconds(1)) {
    receive(packet(kAnswers, kSecond, kAddress, kElsewhere));
    EXPECT_THAT(taken(), ElementsAre(std::pair(kAddress, kFirst)));
    takers.pop_due(now += seconds(1));
  }
  EXPECT_THAT(taken(), ElementsAre(std::pair(kAddress, kFirst))) << "the conflict lasts";
  receive(packet(kAnswers, kSecond, kAddress, kElsewhere));
  EXPECT_THAT(taken(), ElementsAre(std::pair(kAddress, kSecond)));
}

TEST_F(AddressConflictsTest, AreForgottenWithTheAddress) {
  receive(packet(kAnswers, kFirst, kAddress, kElsewhere));
  receive(packet(kAnswers, kFirst, kAnother, kElsewhere));
  takers.set_own({kAnother, kElsewhere}, {kOwn}, now);
  EXPECT_THAT(taken(), ElementsAre(std::pair(kAnother, kFirst)));
  takers.set_own({kAnother, kAddress}, {kOwn}, now);
  EXPECT_THAT(taken(), ElementsAre(std::pair(kAnother, kFirst)));
}

TEST_F(AddressConflictsTest, AreProbedForANewAddressOnly) {
  ConflictDetector fresh;
  EXPECT_EQ(fresh.wake(), std::nullopt);
  fresh.set_own({kAddress}, {kOwn}, now);
  EXPECT_THAT(fresh.pop_due(now), ElementsAre(kAddress));
  for (const seconds gap : ConflictDetector::kFirstGaps) {
    EXPECT_THAT(fresh.pop_due(now), IsEmpty());
    now += gap;
    EXPECT_EQ(fresh.wake(), now);
    EXPECT_THAT(fresh.pop_due(now), ElementsAre(kAddress));
  }
  EXPECT_EQ(fresh.wake(), std::nullopt);
  fresh.set_own({kAddress}, {kOwn}, now);
  EXPECT_EQ(fresh.wake(), std::nullopt) << "the address was probed already";
  fresh.restart_probing(now);
  EXPECT_THAT(fresh.pop_due(now), ElementsAre(kAddress)) << "the cable was plugged in";
}

TEST_F(AddressConflictsTest, AreNotLostBetweenTheFirstProbes) {
  ConflictDetector fresh;
  const auto began = now;
  fresh.set_own({kAddress}, {kOwn}, now);
  const auto all = read_arp(packet(kAnswers, kFirst, kAddress, kElsewhere));
  for (; now < began + std::chrono::minutes(2); now = *fresh.wake()) {
    if (!fresh.pop_due(now).empty() && now > began + seconds(2)) fresh.on_packet(*all, now);
    ASSERT_TRUE(fresh.wake());
    const std::size_t answering = now >= began + seconds(15) ? 1 : 0;
    ASSERT_EQ(fresh.conflicts().size(), answering) << "the other host answers each probe";
  }
}

TEST_F(AddressConflictsTest, AreProbedAgainOnlyWhilePresent) {
  receive(packet(kAnswers, kFirst, kAddress, kElsewhere));
  const auto heard = now;
  std::vector<seconds> asked;
  for (; takers.wake(); now = *takers.wake()) {
    if (!takers.pop_due(now).empty()) asked.push_back(std::chrono::duration_cast<seconds>(now - heard));
    if (!takers.wake()) break;
  }
  EXPECT_THAT(asked, ElementsAre(seconds(0), seconds(5), seconds(10), seconds(15), seconds(20)));
  EXPECT_THAT(taken(), IsEmpty());
}

TEST_F(AddressConflictsTest, AreSoughtAfterAForeignProbe) {
  receive(packet(kAsks, kFirst, 0, kAnother));
  EXPECT_THAT(takers.pop_due(now), ElementsAre(kAnother));
  receive(packet(kAnswers, kFirst, kAnother, 0));
  EXPECT_THAT(taken(), ElementsAre(std::pair(kAnother, kFirst)));
}

/// A host sends a thousand packets per second, each with another MAC address.
TEST_F(AddressConflictsTest, AreBoundedAndProbedSeldom) {
  const auto began = now;
  std::size_t asked = 0;
  for (std::uint32_t i = 0; i < 60000; ++i) {
    const Mac sender = {2,
                        1,
                        0,
                        static_cast<std::uint8_t>(i >> 16),
                        static_cast<std::uint8_t>(i >> 8),
                        static_cast<std::uint8_t>(i)};
    receive(packet(kAsks, sender, i % 3 == 0 ? 0 : kAddress, kAddress));
    receive(packet(kAsks, sender, 0x0b000000 + i, kAddress));
    asked += takers.pop_due(now).size();
    now += std::chrono::milliseconds(1);
  }
  EXPECT_EQ(takers.conflicts().size(), 1u);
  EXPECT_LE(asked, static_cast<std::size_t>((now - began) / ConflictDetector::kBetween) + 1);
  std::vector<std::uint32_t> many(1000);
  std::iota(many.begin(), many.end(), 0x0c000000u);
  takers.set_own(many, {kOwn}, now);
  EXPECT_EQ(takers.pop_due(now).size(), ConflictDetector::kMost);
}

/// The kernel runs the filter on an unprivileged socket.
class ArpFilter : public testing::Test {
 protected:
  void SetUp() override {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends.data()), 0);
    sends = loop::FileDescriptor(ends[0]);
    hears = loop::FileDescriptor(ends[1]);
  }
  void set(const std::vector<std::uint32_t>& addresses) {
    auto program = arp_filter(addresses);
    const sock_fprog attached{static_cast<std::uint16_t>(program.size()), program.data()};
    ASSERT_EQ(setsockopt(hears.get(), SOL_SOCKET, SO_ATTACH_FILTER, &attached, sizeof attached), 0);
  }
  bool is_heard(const Bytes& bytes) {
    send(sends.get(), bytes.data(), bytes.size(), 0);
    std::array<std::uint8_t, 128> got{};
    const auto size = recv(hears.get(), got.data(), got.size(), MSG_DONTWAIT);
    return size > 0 && read_arp({got.data(), static_cast<std::size_t>(size)}).has_value();
  }
  loop::FileDescriptor sends, hears;
};

TEST_F(ArpFilter, PassesPacketsFromOurAddressesAndProbesForThem) {
  set({kAddress, kAnother});
  for (const std::uint32_t ours : {kAddress, kAnother}) {
    EXPECT_TRUE(is_heard(packet(kAnswers, kFirst, ours, kElsewhere)));
    EXPECT_TRUE(is_heard(packet(kAsks, kFirst, ours, ours)));
    EXPECT_TRUE(is_heard(packet(kAsks, kFirst, 0, ours)));
    EXPECT_FALSE(is_heard(packet(kAsks, kFirst, kElsewhere, ours))) << "normal traffic";
  }
  Bytes padded = packet(kAnswers, kFirst, kAddress, kElsewhere);
  padded.resize(46);
  EXPECT_TRUE(is_heard(padded)) << "as Ethernet pads it";
  EXPECT_FALSE(is_heard(packet(kAsks, kFirst, kElsewhere, kElsewhere)));
  EXPECT_FALSE(is_heard(packet(kAsks, kFirst, 0, kElsewhere)));
  EXPECT_FALSE(is_heard(Bytes(3, 0)));
  for (const std::size_t byte : {0u, 1u, 2u, 4u, 5u}) {
    Bytes bad = packet(kAnswers, kFirst, kAddress, kElsewhere);
    bad[byte] ^= 0x40;
    EXPECT_FALSE(is_heard(bad)) << byte;
  }
}

TEST_F(ArpFilter, PassesNothingWithoutAnAddress) {
  set({});
  EXPECT_FALSE(is_heard(packet(kAnswers, kFirst, kAddress, kElsewhere)));
  EXPECT_FALSE(is_heard(packet(kAsks, kFirst, 0, 0)));
}

TEST_F(ArpFilter, HoldsAllWatchedAddresses) {
  std::vector<std::uint32_t> many(
      2 * ConflictDetector::kMost);  // the box's own addresses, and the Command Post's
  std::iota(many.begin(), many.end(), 0x0c000000u);
  set(many);
  EXPECT_TRUE(is_heard(packet(kAnswers, kFirst, many.back(), kElsewhere)));
  EXPECT_TRUE(is_heard(packet(kAsks, kFirst, 0, many.front())));
  EXPECT_FALSE(is_heard(packet(kAnswers, kFirst, many.back() + 1, kElsewhere)));
}

}  // namespace
}  // namespace adit::applier
