// A cloud for which the slot is free is packed with the effort with which it is there first.
#include <gtest/gtest.h>

#include <random>

#include "forward/clouds.hpp"
#include "forward/letting_post.hpp"
#include "forward/stitched.hpp"

namespace adit::forward {
namespace {

/// A large one, which packing makes a third smaller.
icd::MapUpdate large_cloud(const char* robot, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<float> xs(40'000);
  for (float& x : xs) x = std::uniform_real_distribution<float>(0, 100)(random);
  return cloud_along_x(robot, xs);
}

lanes::WaitingMap waiting(icd::MapUpdate map, lanes::Precision precision = lanes::Precision::Exact) {
  lanes::WaitingMap waiting;
  waiting.map = std::move(map);
  waiting.precision = precision;
  return waiting;
}

constexpr pack::Hurry kFast{.bytes_per_second = 1e10, .slowness = 1, .longest = 1},
    kSlow{.bytes_per_second = 1e5, .slowness = 1, .longest = 1};

TEST(HurriedCloud, GoesAsItCameWhereTheLinkIsFast) {
  const icd::MapUpdate cloud = large_cloud("r1");
  const Packed hurried = packed(waiting(cloud), {}, {.hurry = kFast});
  EXPECT_EQ(hurried.effort, pack::Effort::None);
  EXPECT_GE(hurried.body.size(), cloud.data.bytes.size());
}

TEST(HurriedCloud, IsPackedAsAnyOtherWhereTheLinkIsSlow) {
  const icd::MapUpdate cloud = large_cloud("r1");
  const Packed hurried = packed(waiting(cloud), {}, {.hurry = kSlow});
  EXPECT_EQ(hurried.effort, pack::Effort::Full);
  EXPECT_EQ(hurried.body, packed(waiting(cloud)).body);
}

TEST(HurriedCloud, IsRoundedWhereItIsToBe) {
  const icd::MapUpdate cloud = large_cloud("r1");
  for (const auto precision : {lanes::Precision::Millimetre, lanes::Precision::EightMillimetres}) {
    const Packed hurried = packed(waiting(cloud, precision), {}, {.hurry = kFast});
    EXPECT_EQ(hurried.body, packed(waiting(cloud, precision)).body);
    EXPECT_EQ(hurried.precision, precision);
  }
}

class AwaitedCloud : public WithLettingPost {
 protected:
  AwaitedCloud() {
    settings_.command_post.rates.map_hz = 10;
    settings_.command_post.budget_mbit = 100'000;
    maps_->settings_changed();
    maps_->endpoint_changed(icd::BearerToken::parse("a-token"));  // by it the link is given the budget
    for (int i = 0; i < 50; ++i) post_.answer("200 OK");
  }
  api::ActivityRow row() const {
    const auto found = record_.rows().find({Kind::Cloud, "first"});
    return found == record_.rows().end() ? api::ActivityRow{} : found->second;
  }
  /// Of one more, once it was taken.
  std::uint64_t bytes_of(const icd::MapUpdate& cloud) {
    const std::uint64_t taken = row().forwarded;
    take(cloud);
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return row().forwarded > taken; }));
    return row().bytes_sent;
  }
};

TEST_F(AwaitedCloud, IsPackedUntilAMapHasShownHowFastTheLinkIs) {
  const icd::MapUpdate cloud = large_cloud("first");
  EXPECT_LT(bytes_of(cloud), cloud.data.bytes.size());
}

/// Once its slot is free before it comes: on a busy machine it may be taken now and then, or the link slow.
TEST_F(AwaitedCloud, LeavesAsItCameOnceTheLinkIsKnownToBeFast) {
  const icd::MapUpdate cloud = large_cloud("first");
  bool as_it_came = false;
  for (int attempt = 0; attempt < 50 && !as_it_came; ++attempt) {
    as_it_came = bytes_of(cloud) >= cloud.data.bytes.size();
    loop::turn_for(loop_, std::chrono::milliseconds(150));
  }
  EXPECT_TRUE(as_it_came);
}

}  // namespace
}  // namespace adit::forward
