// Clouds that newer ones replace: where a setting says so, and where they were compared.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <set>

#include "lanes/map_lane.hpp"
#include "lanes/maps.hpp"

namespace adit::lanes {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t kRoom = 1 << 20;
using Points = std::set<std::uint8_t>;

MapLane lane_of(Clouds clouds) {
  MapLane lane{kRoom};
  lane.clouds_are({{*robot("R1"), clouds}});
  return lane;
}

Points set_of(const icd::MapData& data) {
  const auto points = points_of({{}, icd::xyz(), data});
  return {points.begin(), points.end()};
}

/// As the flow does it.
std::vector<std::uint64_t> compare_all(MapLane& lane) {
  std::vector<std::uint64_t> gone;
  while (const auto two = lane.to_compare()) {
    if (std::ranges::includes(set_of(two->newer), set_of(two->older))) {
      for (const auto number : lane.replace(*two)) gone.push_back(number);
    } else {
      lane.keep_both(*two);
    }
  }
  return gone;
}

TEST(WholeClouds, ReplaceThoseThatWaitAndTakeTheirAge) {
  MapLane lane = lane_of(Clouds::Whole);
  lane.add(1, cloud_update("R2", {9}), at(0));
  EXPECT_FALSE(lane.replaces_any(cloud_update("R1", {2})));
  lane.add(2, cloud_update("R1", {1, 2}), at(1));
  EXPECT_TRUE(lane.replaces_any(cloud_update("R1", {3})));
  EXPECT_FALSE(lane.replaces_any(cloud_update("R2", {3})));
  EXPECT_THAT(lane.add(3, cloud_update("R1", {3}), at(2)), ElementsAre(2));
  EXPECT_EQ(lane.count(), 2);
  EXPECT_THAT(lane.take()->updates, ElementsAre(1));
  const auto whole = *lane.take();
  EXPECT_THAT(whole.updates, ElementsAre(2, 3));
  EXPECT_THAT(points_of(whole.map), ElementsAre(3));
  EXPECT_EQ(whole.accepted, at(1));
  EXPECT_EQ(lane.bytes(), 0);
}

TEST(WholeClouds, ThatComeBackGiveWayToANewerOne) {
  MapLane lane = lane_of(Clouds::Whole);
  lane.add(1, cloud_update("R1", {1}), at(1));
  auto under_way = *lane.take();
  lane.add(2, cloud_update("R1", {2}), at(2));
  EXPECT_THAT(lane.put_back(std::move(under_way)), ElementsAre(1));
  EXPECT_THAT(points_of(lane.take()->map), ElementsAre(2));
  EXPECT_EQ(lane.count(), 0);
}

TEST(WholeClouds, LeaveGridsOfTheirRobotAlone) {
  MapLane lane = lane_of(Clouds::Whole);
  lane.add(1, grid_update("R1", grid(0, 0, 2, 2)), at(1));
  EXPECT_THAT(lane.add(2, cloud_update("R1", {1}), at(2)), IsEmpty());
  EXPECT_THAT(lane.add(3, grid_update("R1", grid(5, 5, 2, 2)), at(3)), IsEmpty());
}

TEST(ComparedClouds, AreReplacedByOneThatHasTheirPoints) {
  MapLane lane{kRoom};
  lane.add(1, cloud_update("R1", {1, 2}), at(1));
  EXPECT_FALSE(lane.to_compare()) << "nothing to compare it with";
  lane.add(2, cloud_update("R1", {2, 3, 1}), at(2));
  EXPECT_THAT(compare_all(lane), ElementsAre(1));
  lane.add(3, cloud_update("R1", {4}), at(3));
  EXPECT_THAT(compare_all(lane), IsEmpty());
  EXPECT_FALSE(lane.to_compare()) << "it is known";
  EXPECT_EQ(lane.count(), 2);
  const auto merged = *lane.take();
  EXPECT_THAT(merged.updates, ElementsAre(1, 2, 3));
  EXPECT_THAT(points_of(merged.map), ElementsAre(2, 3, 1, 4));
  EXPECT_EQ(merged.accepted, at(1));
  EXPECT_EQ(lane.bytes(), 0);
}

TEST(ComparedClouds, AreThoseOfOneKindOfPointsOnly) {
  auto other = icd::xyz();
  other.is_bigendian = true;
  MapLane lane{kRoom};
  lane.add(1, cloud_update("R1", {1}), at(1));
  lane.add(2, cloud_update("R1", {1, 2}, other), at(2));
  lane.add(3, cloud_update("R2", {1, 2}), at(3));
  EXPECT_FALSE(lane.to_compare());
}

TEST(ComparedClouds, AreNotWhatASettingSaysArrives) {
  MapLane lane = lane_of(Clouds::Parts);
  lane.add(1, cloud_update("R1", {1}), at(1));
  lane.add(2, cloud_update("R1", {1}), at(2));
  EXPECT_FALSE(lane.to_compare());
}

TEST(ComparedClouds, StayWhereOneHasChangedMeanwhile) {
  MapLane lane{kRoom};
  lane.add(1, cloud_update("R1", {1}), at(1));
  lane.add(2, cloud_update("R1", {2}), at(2));
  lane.add(3, cloud_update("R1", {2, 3}), at(3));
  const auto two = *lane.to_compare();
  lane.put_back(*lane.take());  // merged, with what was not compared
  lane.add(4, cloud_update("R1", {4}), at(4));
  EXPECT_THAT(lane.replace(two), IsEmpty());
  EXPECT_THAT(points_of(lane.take()->map), ElementsAre(1, 2, 2, 3, 4));
}

/// Posts of one robot, some whole and some parts, sent, failed and compared in any order.
class CloudsCourse {
 public:
  CloudsCourse(std::uint64_t seed, Clouds clouds) : random_{seed}, lane_{lane_of(clouds)} {}

  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      const int what = pick(8);
      if (what < 3) add();
      if (what == 3 && !two_) two_ = lane_.to_compare();
      if (what == 4) answer();
      if (what >= 5) send(what > 5);
    }
    while (lane_.count() > 0) send(true);
  }

  Points posted, sent;
  std::vector<std::uint8_t> newest, last;  // the points of the last that was posted and of the last sent

 private:
  int pick(int below) { return std::uniform_int_distribution{0, below - 1}(random_); }

  void add() {
    std::vector<std::uint8_t> points;
    if (pick(3) > 0) points = newest;
    for (int i = pick(4); i > 0; --i) points.push_back(static_cast<std::uint8_t>(pick(250)));
    if (pick(2) == 0) std::ranges::shuffle(points, random_);
    posted.insert(points.begin(), points.end());
    ++number_;
    lane_.add(number_, cloud_update("R1", points), at(static_cast<double>(number_)));
    newest = points;
  }

  void answer() {
    if (!two_) return;
    if (std::ranges::includes(set_of(two_->newer), set_of(two_->older))) {
      lane_.replace(*two_);
    } else {
      lane_.keep_both(*two_);
    }
    two_.reset();
  }

  void send(bool taken) {
    auto next = lane_.take();
    if (!next) return;
    while (pick(3) == 0) add();
    if (!taken) {
      lane_.put_back(std::move(*next));
      return;
    }
    last = points_of(next->map);
    sent.insert(last.begin(), last.end());
  }

  std::mt19937_64 random_;
  MapLane lane_;
  std::optional<Successive> two_;
  std::uint64_t number_ = 0;
};

class CloudLaws : public testing::TestWithParam<std::uint64_t> {};

TEST_P(CloudLaws, NoPostedPointIsLostWhereNothingSaysThatCloudsAreWhole) {
  for (const Clouds clouds : {Clouds::Auto, Clouds::Parts}) {
    CloudsCourse course{GetParam(), clouds};
    course.run(150);
    EXPECT_EQ(course.sent, course.posted);
  }
}

TEST_P(CloudLaws, TheNewestPostedIsWhatIsSentLastWhereTheyAreWhole) {
  CloudsCourse course{GetParam(), Clouds::Whole};
  course.run(150);
  EXPECT_EQ(course.last, course.newest);
}

INSTANTIATE_TEST_SUITE_P(Courses, CloudLaws, testing::Range(std::uint64_t{1}, std::uint64_t{41}));

}  // namespace
}  // namespace adit::lanes
