// Queued clouds. Nothing is sent without a token.
#include <gtest/gtest.h>

#include <vector>

#include "forward/fixtures.hpp"
#include "forward/sample_maps.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

class QueuedClouds : public testing::Test, protected MapsParts {
 protected:
  void accept(const std::vector<float>& xs) {
    bool told = false;
    maps_.accept(cloud_along_x("r1", xs), {.bytes = 10}, nullptr, [&](const icd::Checked<void>& taken) {
      EXPECT_TRUE(taken);
      told = true;
    });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return told; }));
  }
  bool becomes(std::size_t count) {
    return loop::turn_until(loop_, [&] { return maps_.waiting(kClouds) == count; });
  }
  const facts::ActivityRow& row() const { return counts_.rows().at(kClouds); }

  const Traffic kClouds{TrafficKind::Cloud, "r1"};
  Maps maps_ = maps_with(std::nullopt);
};

TEST_F(QueuedClouds, AreReplacedByOneWithAllTheirPoints) {
  accept({1, 2});
  EXPECT_EQ(row().clouds, "");
  accept({1, 2, 3});
  accept({3, 4, 2, 1});
  EXPECT_TRUE(becomes(1));
  EXPECT_EQ(row().clouds, "whole");
  EXPECT_EQ(row().replaced, 2);
}

TEST_F(QueuedClouds, StayIfANewerOneLacksAPoint) {
  accept({1, 2});
  accept({3, 1, 4});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return !row().clouds.empty(); }));
  EXPECT_EQ(row().clouds, "parts");
  accept({3, 1, 4, 5});
  EXPECT_TRUE(becomes(2)) << "the part stays";
  EXPECT_EQ(row().replaced, 1);
}

TEST_F(QueuedClouds, AreReplacedIfTheSettingIsWhole) {
  settings_.robots = {{.name = "r1", .alias = "", .clouds = queues::Clouds::Whole}};
  maps_.on_settings_changed();
  accept({1, 2});
  accept({7});
  EXPECT_EQ(maps_.waiting(kClouds), 1);
  EXPECT_EQ(row().clouds, "whole");
}

TEST_F(QueuedClouds, StayIfTheSettingIsParts) {
  settings_.robots = {{.name = "r1", .alias = "", .clouds = queues::Clouds::Parts}};
  maps_.on_settings_changed();
  accept({1, 2});
  accept({1, 2});
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_EQ(maps_.waiting(kClouds), 2);
  EXPECT_EQ(row().clouds, "parts");
}

TEST_F(QueuedClouds, AreComparedAtARestart) {
  maps_.restore({{MapStore::kFirstNumber + 1, cloud_along_x("r1", {1, 2})},
                 {MapStore::kFirstNumber + 2, cloud_along_x("r1", {1, 2, 3})}});
  EXPECT_TRUE(becomes(1));
}

}  // namespace
}  // namespace adit::forward
