#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/observed_facts.hpp"

namespace adit::gateway {
namespace {

using namespace std::chrono_literals;
using intake::CloseReason;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

constexpr loop::Instant kFirst{100h};

auto of(const char* address) {
  return Field(&facts::Crowd::address, address);
}

TEST(Crowding, IsEmptyAtFirst) {
  Crowding crowding;
  EXPECT_THAT(crowding.crowds(kFirst), IsEmpty());
  EXPECT_THAT(crowding.to_log(kFirst), IsEmpty());
}

TEST(Crowding, NamesTheBusiestAddressWhileItLasts) {
  Crowding crowding;
  crowding.on_ended(CloseReason::GaveWay, "10.0.0.7", kFirst);
  for (int i = 0; i < 5; ++i) crowding.on_ended(CloseReason::GaveWay, "10.0.0.9", kFirst + 30s);
  crowding.on_ended(CloseReason::NoRoom, "10.0.0.8", kFirst);
  EXPECT_THAT(crowding.crowds(kFirst + 59s), ElementsAre(of("10.0.0.8"), of("10.0.0.9")));
  EXPECT_THAT(crowding.crowds(kFirst + 60s), ElementsAre(of("10.0.0.9")));
  EXPECT_THAT(crowding.crowds(kFirst + 90s), IsEmpty());
  crowding.on_ended(CloseReason::GaveWay, "10.0.0.7", kFirst + 9min);
  EXPECT_THAT(crowding.crowds(kFirst + 9min), ElementsAre(of("10.0.0.7"))) << "the other events are too old";
}

TEST(Crowding, ReportsWrongTokens) {
  Crowding crowding;
  for (int i = 0; i < 1786; ++i) crowding.on_ended(CloseReason::WrongToken, "10.0.0.7", kFirst);
  EXPECT_THAT(crowding.crowds(kFirst),
              ElementsAre(Field(&facts::Crowd::kind, facts::Crowd::Kind::WrongToken)));
  const auto lines = crowding.to_log(kFirst);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines.front().times, 1786u);
}

TEST(Crowding, TellsAClientWithoutATokenFromAWrongOne) {
  Crowding crowding;
  crowding.on_ended(CloseReason::NoToken, "10.0.0.7", kFirst);
  EXPECT_THAT(crowding.crowds(kFirst), ElementsAre(Field(&facts::Crowd::kind, facts::Crowd::Kind::NoToken)));
  EXPECT_THAT(crowding.crowds(kFirst), ElementsAre(of("10.0.0.7")));
  EXPECT_EQ(crowding.count(CloseReason::WrongToken), 0u);
  ASSERT_EQ(crowding.to_log(kFirst).size(), 1u);
}

TEST(Crowding, IsLoggedAtOnceAndThenOnceAMinute) {
  Crowding crowding;
  const auto times = [&](loop::Instant now) {
    std::vector<std::uint64_t> numbers;
    for (const auto& line : crowding.to_log(now)) numbers.push_back(line.times);
    return numbers;
  };
  crowding.on_ended(CloseReason::NoRoom, "10.0.0.8", kFirst);
  EXPECT_THAT(times(kFirst), ElementsAre(1));
  for (int i = 0; i < 1000; ++i) crowding.on_ended(CloseReason::NoRoom, "10.0.0.8", kFirst + 1s);
  EXPECT_THAT(times(kFirst + 59s), IsEmpty());
  EXPECT_THAT(times(kFirst + 60s), ElementsAre(1000));
  EXPECT_THAT(times(kFirst + 10min), IsEmpty());
}

TEST(Crowding, OnlyCountsIdleAndSlowConnections) {
  Crowding crowding;
  crowding.on_ended(CloseReason::Idle, "10.0.0.8", kFirst);
  crowding.on_ended(CloseReason::Slow, "10.0.0.8", kFirst);
  EXPECT_EQ(crowding.count(CloseReason::Idle), 1u);
  EXPECT_EQ(crowding.count(CloseReason::Slow), 1u);
  EXPECT_EQ(crowding.count(CloseReason::NoRoom), 0u);
  EXPECT_THAT(crowding.crowds(kFirst), IsEmpty());
}

TEST(Crowding, LimitsItsAddresses) {
  Crowding crowding;
  for (int i = 0; i < 10'000; ++i) crowding.on_ended(CloseReason::GaveWay, std::to_string(i), kFirst);
  crowding.on_ended(CloseReason::GaveWay, "0", kFirst);
  EXPECT_THAT(crowding.crowds(kFirst), ElementsAre(of("0")));
  EXPECT_EQ(crowding.count(CloseReason::GaveWay), 10'001u);
}

}  // namespace
}  // namespace adit::gateway
