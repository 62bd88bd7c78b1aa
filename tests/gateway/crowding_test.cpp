#include "gateway/crowding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace adit::gateway {
namespace {

using namespace std::chrono_literals;
using intake::Ended;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

constexpr loop::Instant kStart{100h};

auto of(const char* address) {
  return Field(&alarms::Crowd::address, address);
}

TEST(Crowding, OfNobodySaysNothing) {
  Crowding crowding;
  EXPECT_THAT(crowding.crowds(kStart), IsEmpty());
  EXPECT_THAT(crowding.to_log(kStart), IsEmpty());
}

TEST(Crowding, IsToldOfWhileItGoesOnWithTheAddressThatHasMost) {
  Crowding crowding;
  crowding.ended(Ended::GaveWay, "10.0.0.7", kStart);
  for (int i = 0; i < 5; ++i) crowding.ended(Ended::GaveWay, "10.0.0.9", kStart + 30s);
  crowding.ended(Ended::NoRoom, "10.0.0.8", kStart);
  EXPECT_THAT(crowding.crowds(kStart + 59s), ElementsAre(of("10.0.0.8"), of("10.0.0.9")));
  EXPECT_THAT(crowding.crowds(kStart + 60s), ElementsAre(of("10.0.0.9")));
  EXPECT_THAT(crowding.crowds(kStart + 90s), IsEmpty());
  crowding.ended(Ended::GaveWay, "10.0.0.7", kStart + 9min);
  EXPECT_THAT(crowding.crowds(kStart + 9min), ElementsAre(of("10.0.0.7"))) << "the rest is long ago";
}

TEST(Crowding, TellsOfWrongTokens) {
  Crowding crowding;
  for (int i = 0; i < 1786; ++i) crowding.ended(Ended::WrongToken, "10.0.0.7", kStart);
  EXPECT_THAT(crowding.crowds(kStart), ElementsAre(Field(&alarms::Crowd::is, alarms::Crowd::Is::WrongToken)));
  const auto lines = crowding.to_log(kStart);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines.front().times, 1786u);
}

TEST(Crowding, IsLoggedAtOnceAndThenOnceAMinuteWithItsNumber) {
  Crowding crowding;
  const auto times = [&](loop::Instant now) {
    std::vector<std::uint64_t> numbers;
    for (const auto& line : crowding.to_log(now)) numbers.push_back(line.times);
    return numbers;
  };
  crowding.ended(Ended::NoRoom, "10.0.0.8", kStart);
  EXPECT_THAT(times(kStart), ElementsAre(1));
  for (int i = 0; i < 1000; ++i) crowding.ended(Ended::NoRoom, "10.0.0.8", kStart + 1s);
  EXPECT_THAT(times(kStart + 59s), IsEmpty());
  EXPECT_THAT(times(kStart + 60s), ElementsAre(1000));
  EXPECT_THAT(times(kStart + 10min), IsEmpty());
}

TEST(Crowding, OfIdleAndSlowConnectionsIsCountedAlone) {
  Crowding crowding;
  crowding.ended(Ended::Idle, "10.0.0.8", kStart);
  crowding.ended(Ended::Slow, "10.0.0.8", kStart);
  EXPECT_EQ(crowding.count(Ended::Idle), 1u);
  EXPECT_EQ(crowding.count(Ended::Slow), 1u);
  EXPECT_EQ(crowding.count(Ended::NoRoom), 0u);
  EXPECT_THAT(crowding.crowds(kStart), IsEmpty());
}

TEST(Crowding, RemembersOnlySoManyAddresses) {
  Crowding crowding;
  for (int i = 0; i < 10'000; ++i) crowding.ended(Ended::GaveWay, std::to_string(i), kStart);
  crowding.ended(Ended::GaveWay, "0", kStart);
  EXPECT_THAT(crowding.crowds(kStart), ElementsAre(of("0")));
  EXPECT_EQ(crowding.count(Ended::GaveWay), 10'001u);
}

}  // namespace
}  // namespace adit::gateway
