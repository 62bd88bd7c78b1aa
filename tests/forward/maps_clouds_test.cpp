// What becomes of clouds that wait: nothing is sent here, for there is no token.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "forward/around.hpp"
#include "forward/maps.hpp"
#include "icd/xyz.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

constexpr std::size_t kStep = 12;

icd::MapUpdate cloud_of(const std::vector<std::uint8_t>& points) {
  const icd::PointCloud2 cloud = icd::xyz();
  std::vector<std::uint8_t> bytes;
  for (const std::uint8_t point : points) bytes.insert(bytes.end(), kStep, point);
  return {
      icd::RobotName::parse("r1"), cloud, {icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()}};
}

class CloudsThatWait : public testing::Test, protected AroundMaps {
 protected:
  void take(const std::vector<std::uint8_t>& points) {
    bool told = false;
    maps_.take(cloud_of(points), 10, nullptr, [&](const icd::Checked<void>& taken) {
      EXPECT_TRUE(taken);
      told = true;
    });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return told; }));
  }
  bool come_to_be(std::size_t count) {
    return loop::turn_until(loop_, [&] { return maps_.waiting(kClouds) == count; });
  }
  const api::ActivityRow& row() const { return record_.rows().at(kClouds); }

  const Traffic kClouds{Kind::Cloud, "r1"};
  Maps maps_{loop_,
             workers_,
             writer_,
             spool_,
             settings_,
             {},
             record_,
             rejected_,
             random_,
             journal_,
             [](const icd::MapUpdate&) {}};
};

TEST_F(CloudsThatWait, AreReplacedByOneWithAllTheirPoints) {
  take({1, 2});
  EXPECT_EQ(row().clouds, "");
  take({1, 2, 3});
  take({3, 4, 2, 1});
  EXPECT_TRUE(come_to_be(1));
  EXPECT_EQ(row().clouds, "whole");
  EXPECT_EQ(row().replaced, 2);
}

TEST_F(CloudsThatWait, StayWhereANewerOneLacksAPoint) {
  take({1, 2});
  take({3, 1, 4});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return !row().clouds.empty(); }));
  EXPECT_EQ(row().clouds, "parts");
  take({3, 1, 4, 5});
  EXPECT_TRUE(come_to_be(2)) << "the part is still there";
  EXPECT_EQ(row().replaced, 1);
}

TEST_F(CloudsThatWait, AreReplacedByTheNewestWhereTheSettingSaysThatTheyAreWhole) {
  settings_.robots = {{.name = "r1", .alias = "", .clouds = queues::Clouds::Whole}};
  maps_.settings_changed();
  take({1, 2});
  take({7});
  EXPECT_EQ(maps_.waiting(kClouds), 1);
  EXPECT_EQ(row().clouds, "whole");
}

TEST_F(CloudsThatWait, AllArriveWhereTheSettingSaysThatTheyAreParts) {
  settings_.robots = {{.name = "r1", .alias = "", .clouds = queues::Clouds::Parts}};
  maps_.settings_changed();
  take({1, 2});
  take({1, 2});
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_EQ(maps_.waiting(kClouds), 2);
  EXPECT_EQ(row().clouds, "parts");
}

TEST_F(CloudsThatWait, AreComparedAlsoWhenALifeBegins) {
  maps_.restore(
      {{MapStore::kFirstNumber + 1, cloud_of({1, 2})}, {MapStore::kFirstNumber + 2, cloud_of({1, 2, 3})}});
  EXPECT_TRUE(come_to_be(1));
}

}  // namespace
}  // namespace adit::forward
