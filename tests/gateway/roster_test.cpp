#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/overview.hpp"
#include "icd/sentence.hpp"

namespace adit::gateway {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr loop::Instant kStart{100h};

TEST(Roster, WithoutRobotsAcceptsAll) {
  Roster roster(std::vector<settings::Robot>{});
  EXPECT_FALSE(roster.on_posted("anybody", kStart));
  EXPECT_THAT(roster.unknown(kStart), IsEmpty());
}

TEST(Roster, ReportsAnUnknownRobotWhileItPosts) {
  Roster roster(std::vector<settings::Robot>{{"ugv1", "husky"}, {"ugv2", ""}});
  EXPECT_FALSE(roster.on_posted("ugv1", kStart));
  EXPECT_TRUE(roster.on_posted("uvg1", kStart));
  EXPECT_FALSE(roster.on_posted("uvg1", kStart + 1min)) << "not news";
  EXPECT_THAT(roster.unknown(kStart + 3min - 1s), ElementsAre("uvg1"));
  EXPECT_THAT(roster.unknown(kStart + 3min), IsEmpty());
}

TEST(Roster, LimitsUnknownRobotsAndForgetsTheSilentFirst) {
  Roster roster(std::vector<settings::Robot>{{"ugv1", ""}});
  for (std::size_t i = 0; i < 2 * Roster::kMostUnknown; ++i) roster.on_posted(icd::sentence("x", i), kStart);
  EXPECT_EQ(roster.unknown(kStart).size(), Roster::kMostUnknown);
  EXPECT_TRUE(roster.on_posted("y", kStart + Roster::kRecent));
  EXPECT_THAT(roster.unknown(kStart + Roster::kRecent), ElementsAre("y"));
}

TEST(Roster, ForgetsAnUnknownRobotOnceItIsSetUp) {
  Roster roster(std::vector<settings::Robot>{{"ugv1", ""}});
  roster.on_posted("ugv2", kStart);
  roster.on_posted("x", kStart);
  roster.set_up({{"ugv1", ""}, {"ugv2", ""}});
  EXPECT_FALSE(roster.on_posted("ugv2", kStart));
  EXPECT_THAT(roster.unknown(kStart), ElementsAre("x"));
  roster.set_up({});
  EXPECT_THAT(roster.unknown(kStart), IsEmpty());
}

}  // namespace
}  // namespace adit::gateway
