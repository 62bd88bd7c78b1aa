#include "intake/shares.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace adit::intake {
namespace {

using namespace std::chrono_literals;
using Activity = ConnectionInfo::Activity;

constexpr Shares kShares{.unauthenticated = 4, .known = 6, .known_of_address = 3};
constexpr std::string_view kNew = "new";

std::vector<ConnectionInfo> several(std::uint64_t first, int count, std::string_view address, bool known,
                                    Activity doing) {
  std::vector<ConnectionInfo> held;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t number = first + static_cast<std::uint64_t>(i);
    held.push_back({.number = number,
                    .address = address,
                    .known = known,
                    .doing = doing,
                    .since = loop::Instant(std::chrono::seconds(number))});
  }
  return held;
}

std::vector<ConnectionInfo> together(std::initializer_list<std::vector<ConnectionInfo>> parts) {
  std::vector<ConnectionInfo> held;
  for (const auto& part : parts) held.insert(held.end(), part.begin(), part.end());
  return held;
}

TEST(Shares, ReserveMostRoomForAuthenticatedClients) {
  const auto usual = Shares::split(128, 64);
  EXPECT_EQ(usual.unauthenticated, 32u);
  EXPECT_EQ(usual.known, 96u);
  EXPECT_EQ(usual.known_of_address, 64u);
  EXPECT_EQ(Shares::split(1024, 1024).unauthenticated, 32u) << "an absolute limit";
  EXPECT_EQ(Shares::split(20, 64).known_of_address, 15u);
  EXPECT_EQ(Shares::split(1, 1).known, 1u);
  EXPECT_EQ(Shares::split(1, 1).unauthenticated, 1u);
}

TEST(ConnectionToClose, IsNoneWithinTheShare) {
  const auto held =
      together({several(1, 4, "a", false, Activity::Sending), several(10, 6, "b", true, Activity::Idle)});
  EXPECT_FALSE(unauthenticated_to_close(held, kShares));
}

TEST(ConnectionToClose, IsTheOldestOfTheAddressWithMost) {
  const auto held =
      together({several(1, 2, "a", false, Activity::Sending), several(5, 3, "b", false, Activity::Sending)});
  EXPECT_EQ(unauthenticated_to_close(held, kShares), 5u);
  EXPECT_EQ(unauthenticated_to_close(several(1, 5, "a", false, Activity::Waiting), kShares), 1u);
}

TEST(ConnectionToClose, IsAnIdleOneIfThereIsOne) {
  const auto held =
      together({several(1, 4, "a", false, Activity::Waiting), several(5, 1, "a", false, Activity::Idle)});
  EXPECT_EQ(unauthenticated_to_close(held, kShares), 5u);
}

TEST(ConnectionToClose, IsNotAFreshOne) {
  const auto fresh = several(1, 5, "a", false, Activity::Fresh);
  EXPECT_FALSE(unauthenticated_to_close(fresh, kShares));
  EXPECT_EQ(
      unauthenticated_to_close(together({fresh, several(10, 1, "b", false, Activity::Sending)}), kShares),
      10u);
}

TEST(ConnectionToClose, IsNotAnAuthenticatedOne) {
  const auto held =
      together({several(1, 6, "a", true, Activity::Idle), several(10, 5, "b", false, Activity::Sending)});
  EXPECT_EQ(unauthenticated_to_close(held, kShares), 10u);
}

TEST(RoomForAuthenticatedClients, ExistsBesideAnyNumberOfOthers) {
  const auto others = several(1, 200, "new", false, Activity::Sending);
  EXPECT_TRUE(room_for(kNew, others, kShares).is_there);
  EXPECT_FALSE(room_for(kNew, others, kShares).gives_way);
}

TEST(RoomForAuthenticatedClients, ComesFromTheLongestIdleConnection) {
  const auto others =
      together({several(1, 3, "a", true, Activity::Waiting), several(7, 3, "b", true, Activity::Idle)});
  EXPECT_EQ(room_for(kNew, others, kShares).gives_way, 7u);
}

TEST(RoomForAuthenticatedClients, ComesFromAClosedConnectionIfNoneIsIdle) {
  const auto others =
      together({several(1, 3, "a", true, Activity::Waiting), several(7, 3, "b", true, Activity::Left)});
  EXPECT_EQ(room_for(kNew, others, kShares).gives_way, 7u);
}

TEST(RoomForAuthenticatedClients, IsNoneIfAllWaitForAnswers) {
  const auto others = several(1, 6, "a", true, Activity::Waiting);
  EXPECT_FALSE(room_for(kNew, others, {.unauthenticated = 4, .known = 6, .known_of_address = 6}).is_there);
}

TEST(RoomForAuthenticatedClients, ComesFromAnAddressWithMoreThanItsShare) {
  const auto others =
      together({several(1, 1, "a", true, Activity::Sending), several(3, 2, "b", true, Activity::Waiting),
                several(5, 3, "c", true, Activity::Sending)});
  EXPECT_EQ(room_for(kNew, others, kShares).gives_way, 5u);
  const Shares even{.unauthenticated = 4, .known = 2, .known_of_address = 2};
  EXPECT_FALSE(room_for(kNew,
                        together({several(1, 1, "a", true, Activity::Sending),
                                  several(3, 1, "b", true, Activity::Sending)}),
                        even)
                   .is_there)
      << "no address exceeds its share";
}

TEST(RoomForAuthenticatedClients, IsLimitedForOneAddress) {
  const auto busy = several(1, 3, "new", true, Activity::Sending);
  EXPECT_FALSE(room_for(kNew, busy, kShares).is_there);
  const auto idle =
      together({several(1, 2, "new", true, Activity::Sending), several(8, 1, "new", true, Activity::Idle),
                several(4, 1, "a", true, Activity::Idle)});
  EXPECT_EQ(room_for(kNew, idle, kShares).gives_way, 8u);
}

TEST(RoomFor, KeepsTheSharesInAnyOrder) {
  std::mt19937_64 random(20210917);
  const auto any = [&](std::uint64_t below) { return random() % below; };
  const std::string addresses[] = {"a", "b", "c", "d", "e"};
  constexpr Activity kDoings[] = {Activity::Idle, Activity::Sending, Activity::Left, Activity::Waiting};
  for (int round = 0; round < 200; ++round) {
    std::vector<ConnectionInfo> held;
    for (std::uint64_t number = 1; number < 60; ++number) {
      for (ConnectionInfo& each : held) each.doing = kDoings[any(4)];
      ConnectionInfo newcomer{.number = number,
                              .address = addresses[any(5)],
                              .known = any(2) == 0,
                              .doing = Activity::Sending,
                              .since = loop::Instant(std::chrono::seconds(number))};
      const auto ends = [&](std::uint64_t gone) {
        return std::erase_if(held, [&](const ConnectionInfo& each) { return each.number == gone; }) == 1;
      };
      const Room room = newcomer.known ? room_for(newcomer.address, held, kShares) : Room();
      if (room.gives_way) {
        ASSERT_TRUE(ends(*room.gives_way));
      }
      newcomer.known = newcomer.known && room.is_there;
      held.push_back(newcomer);
      while (const auto gone = unauthenticated_to_close(held, kShares)) ASSERT_TRUE(ends(*gone));
      const auto known = std::ranges::count(held, true, &ConnectionInfo::known);
      ASSERT_LE(held.size() - static_cast<std::size_t>(known), kShares.unauthenticated);
      ASSERT_LE(static_cast<std::size_t>(known), kShares.known);
      for (const std::string& address : addresses)
        ASSERT_LE(
            std::ranges::count_if(
                held, [&](const ConnectionInfo& each) { return each.known && each.address == address; }),
            kShares.known_of_address);
    }
  }
}

}  // namespace
}  // namespace adit::intake
