// Newer clouds replace older ones: if a setting says so, or if a comparison shows it.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <set>

#include "queues/map_queue.hpp"
#include "queues/maps.hpp"

namespace adit::queues {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t kRoom = 1 << 20;
using Points = std::set<std::uint8_t>;

MapQueue queue_of(Clouds clouds) {
  MapQueue queue{kRoom};
  queue.set_cloud_modes({{*robot("R1"), clouds}});
  return queue;
}

Points set_of(const icd::MapData& data) {
  const auto points = points_of({{}, icd::xyz(), data});
  return {points.begin(), points.end()};
}

/// Compares clouds as the flow does.
std::vector<std::uint64_t> compare_all(MapQueue& queue) {
  std::vector<std::uint64_t> gone;
  while (const auto two = queue.uncompared_clouds()) {
    if (std::ranges::includes(set_of(two->newer), set_of(two->older))) {
      for (const auto number : queue.replace(*two)) gone.push_back(number);
    } else {
      queue.keep_both(*two);
    }
  }
  return gone;
}

TEST(WholeClouds, ReplaceQueuedCloudsAndKeepTheirAge) {
  MapQueue queue = queue_of(Clouds::Whole);
  queue.add(1, cloud_update("R2", {9}), at(0));
  EXPECT_FALSE(queue.replaces_any(cloud_update("R1", {2})));
  queue.add(2, cloud_update("R1", {1, 2}), at(1));
  EXPECT_TRUE(queue.replaces_any(cloud_update("R1", {3})));
  EXPECT_FALSE(queue.replaces_any(cloud_update("R2", {3})));
  EXPECT_THAT(queue.add(3, cloud_update("R1", {3}), at(2)).numbers, ElementsAre(2));
  EXPECT_EQ(queue.count(), 2);
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1));
  const auto whole = *queue.pop();
  EXPECT_THAT(whole.updates, ElementsAre(2, 3));
  EXPECT_THAT(points_of(whole.map), ElementsAre(3));
  EXPECT_EQ(whole.accepted, at(1));
  EXPECT_EQ(queue.bytes(), 0);
}

TEST(WholeClouds, FailedCloudIsReplacedByANewerOne) {
  MapQueue queue = queue_of(Clouds::Whole);
  queue.add(1, cloud_update("R1", {1}), at(1));
  auto under_way = *queue.pop();
  queue.add(2, cloud_update("R1", {2}), at(2));
  EXPECT_THAT(queue.put_back(std::move(under_way)).numbers, ElementsAre(1));
  EXPECT_THAT(points_of(queue.pop()->map), ElementsAre(2));
  EXPECT_EQ(queue.count(), 0);
}

TEST(WholeClouds, LeaveGridsOfTheirRobotAlone) {
  MapQueue queue = queue_of(Clouds::Whole);
  queue.add(1, grid_update("R1", grid(0, 0, 2, 2)), at(1));
  EXPECT_THAT(queue.add(2, cloud_update("R1", {1}), at(2)).numbers, IsEmpty());
  EXPECT_THAT(queue.add(3, grid_update("R1", grid(5, 5, 2, 2)), at(3)).numbers, IsEmpty());
}

TEST(ComparedClouds, AreReplacedByACloudWithAllTheirPoints) {
  MapQueue queue{kRoom};
  queue.add(1, cloud_update("R1", {1, 2}), at(1));
  EXPECT_FALSE(queue.uncompared_clouds()) << "no other cloud to compare it with";
  queue.add(2, cloud_update("R1", {2, 3, 1}), at(2));
  EXPECT_THAT(compare_all(queue), ElementsAre(1));
  queue.add(3, cloud_update("R1", {4}), at(3));
  EXPECT_THAT(compare_all(queue), IsEmpty());
  EXPECT_FALSE(queue.uncompared_clouds()) << "the comparison was made";
  EXPECT_EQ(queue.count(), 2);
  const auto merged = *queue.pop();
  EXPECT_THAT(merged.updates, ElementsAre(1, 2, 3));
  EXPECT_THAT(points_of(merged.map), ElementsAre(2, 3, 1, 4));
  EXPECT_EQ(merged.accepted, at(1));
  EXPECT_EQ(queue.bytes(), 0);
}

TEST(ComparedClouds, ShareRobotAndPointLayout) {
  auto other = icd::xyz();
  other.is_bigendian = true;
  MapQueue queue{kRoom};
  queue.add(1, cloud_update("R1", {1}), at(1));
  queue.add(2, cloud_update("R1", {1, 2}, other), at(2));
  queue.add(3, cloud_update("R2", {1, 2}), at(3));
  EXPECT_FALSE(queue.uncompared_clouds());
}

TEST(ComparedClouds, AreNoneIfTheSettingIsParts) {
  MapQueue queue = queue_of(Clouds::Parts);
  queue.add(1, cloud_update("R1", {1}), at(1));
  queue.add(2, cloud_update("R1", {1}), at(2));
  EXPECT_FALSE(queue.uncompared_clouds());
}

TEST(ComparedClouds, StayIfOneChangedMeanwhile) {
  MapQueue queue{kRoom};
  queue.add(1, cloud_update("R1", {1}), at(1));
  queue.add(2, cloud_update("R1", {2}), at(2));
  queue.add(3, cloud_update("R1", {2, 3}), at(3));
  const auto two = *queue.uncompared_clouds();
  queue.put_back(*queue.pop());  // merged with the cloud that was not compared
  queue.add(4, cloud_update("R1", {4}), at(4));
  EXPECT_THAT(queue.replace(two), IsEmpty());
  EXPECT_THAT(points_of(queue.pop()->map), ElementsAre(1, 2, 2, 3, 4));
}

/// One robot's whole and partial clouds, posted, sent, failed and compared in any order.
class CloudsCourse {
 public:
  CloudsCourse(std::uint64_t seed, Clouds clouds) : random_{seed}, queue_{queue_of(clouds)} {}

  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      const int what = pick(8);
      if (what < 3) add();
      if (what == 3 && !two_) two_ = queue_.uncompared_clouds();
      if (what == 4) answer();
      if (what >= 5) send(what > 5);
    }
    while (queue_.count() > 0) send(true);
  }

  Points posted, sent;
  std::vector<std::uint8_t> newest, last;  // points of the last posted and the last sent cloud

 private:
  int pick(int below) { return std::uniform_int_distribution{0, below - 1}(random_); }

  void add() {
    std::vector<std::uint8_t> points;
    if (pick(3) > 0) points = newest;
    for (int i = pick(4); i > 0; --i) points.push_back(static_cast<std::uint8_t>(pick(250)));
    if (pick(2) == 0) std::ranges::shuffle(points, random_);
    posted.insert(points.begin(), points.end());
    ++number_;
    queue_.add(number_, cloud_update("R1", points), at(static_cast<double>(number_)));
    newest = points;
  }

  void answer() {
    if (!two_) return;
    if (std::ranges::includes(set_of(two_->newer), set_of(two_->older))) {
      queue_.replace(*two_);
    } else {
      queue_.keep_both(*two_);
    }
    two_.reset();
  }

  void send(bool taken) {
    auto next = queue_.pop();
    if (!next) return;
    while (pick(3) == 0) add();
    if (!taken) {
      queue_.put_back(std::move(*next));
      return;
    }
    last = points_of(next->map);
    sent.insert(last.begin(), last.end());
  }

  std::mt19937_64 random_;
  MapQueue queue_;
  std::optional<CloudPair> two_;
  std::uint64_t number_ = 0;
};

class CloudLaws : public testing::TestWithParam<std::uint64_t> {};

TEST_P(CloudLaws, NoPointIsLostUnlessCloudsAreWhole) {
  for (const Clouds clouds : {Clouds::Auto, Clouds::Parts}) {
    CloudsCourse course{GetParam(), clouds};
    course.run(150);
    EXPECT_EQ(course.sent, course.posted);
  }
}

TEST_P(CloudLaws, NewestWholeCloudIsSentLast) {
  CloudsCourse course{GetParam(), Clouds::Whole};
  course.run(150);
  EXPECT_EQ(course.last, course.newest);
}

INSTANTIATE_TEST_SUITE_P(Courses, CloudLaws, testing::Range(std::uint64_t{1}, std::uint64_t{41}));

}  // namespace
}  // namespace adit::queues
