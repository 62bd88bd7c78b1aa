// Invariants of MapQueue over random sequences of add, take and put_back.
#include <gmock/gmock.h>

#include <map>
#include <random>
#include <set>
#include <string>

#include "queues/lattice.hpp"
#include "queues/map_queue.hpp"
#include "queues/maps.hpp"

namespace adit::queues {
namespace {

constexpr std::size_t kMergeBytes = 60;  // five points

/// Drives a queue with random calls that a gateway can make, and records its inputs and outputs.
class Course {
 public:
  /// Every second course has grids on many lattices.
  explicit Course(std::uint64_t seed) : random_{seed}, drifts_(seed % 2 == 0) {}

  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      const int what = pick(10);
      if (what < 5) add();
      if (what >= 5 && what < 8) send(/*taken=*/true);
      if (what >= 8) send(/*taken=*/false);
    }
    while (queue_.count() > 0) send(true);
  }

  MapQueue queue_{kMergeBytes};
  std::map<std::uint64_t, icd::MapUpdate> accepted;  // by number
  std::map<std::uint64_t, Instant> accepted_at;
  std::vector<QueuedMap> sent;
  std::vector<std::uint64_t> replaced;

 private:
  int pick(int below) { return std::uniform_int_distribution{0, below - 1}(random_); }

  void add() {
    const char* const names[] = {"", "R1", "R2"};
    const char* name = names[pick(3)];
    auto update = pick(2) == 0 ? grid_update(name, any_grid()) : any_cloud(name);
    const auto number = static_cast<std::uint64_t>(accepted.size());
    accepted.emplace(number, update);
    accepted_at.emplace(number, at(time_ += 1));
    const auto gone = queue_.add(number, update, at(time_)).numbers;
    replaced.insert(replaced.end(), gone.begin(), gone.end());
  }

  icd::OccupancyGrid any_grid() {
    auto any = grid(-0.05 * pick(4), -0.05 * pick(2), static_cast<std::uint32_t>(1 + pick(6)),
                    static_cast<std::uint32_t>(1 + pick(3)));
    if (!drifts_) return any;
    any.origin.position.x += 0.013 * pick(4);
    any.origin.position.z = 0.006 * pick(6);
    return any;
  }

  icd::MapUpdate any_cloud(const char* name) {
    std::vector<std::uint8_t> points;
    for (int i = pick(4); i > 0; --i) points.push_back(++point_);
    auto cloud = icd::xyz();
    cloud.is_bigendian = pick(5) == 0;
    return cloud_update(name, points, cloud);
  }

  void send(bool taken) {
    auto next = queue_.pop();
    if (!next) return;
    while (pick(3) == 0) add();  // while the map is in flight
    if (taken) {
      sent.push_back(std::move(*next));
    } else {
      const auto gone = queue_.put_back(std::move(*next)).numbers;
      replaced.insert(replaced.end(), gone.begin(), gone.end());
    }
  }

  std::mt19937_64 random_;
  const bool drifts_;
  double time_ = 0;
  std::uint8_t point_ = 0;
};

class MapQueueLaws : public testing::TestWithParam<std::uint64_t> {
 protected:
  void SetUp() override { course_.run(400); }
  Course course_{GetParam()};
};

TEST_P(MapQueueLaws, EveryUpdateComesOutExactlyOnce) {
  std::multiset<std::uint64_t> out;
  for (const auto& map : course_.sent) {
    EXPECT_TRUE(std::ranges::is_sorted(map.updates)) << "oldest first";
    out.insert(map.updates.begin(), map.updates.end());
  }
  ASSERT_EQ(out.size(), course_.accepted.size());
  for (const auto& [number, update] : course_.accepted) EXPECT_EQ(out.count(number), 1) << number;
  EXPECT_EQ(course_.queue_.bytes(), 0);
}

TEST_P(MapQueueLaws, EachGridIsSentOrCoveredByALaterOne) {
  for (const auto& [number, update] : course_.accepted) {
    const auto* grid = std::get_if<icd::OccupancyGrid>(&update.msg);
    if (!grid) continue;
    const bool is_sent =
        std::ranges::any_of(course_.sent, [&, n = number, &u = update](const QueuedMap& map) {
          const auto* sent = std::get_if<icd::OccupancyGrid>(&map.map.msg);
          return sent && map.map.name == u.name && map.updates.back() >= n &&
                 std::ranges::count(map.updates, n) == 1 &&
                 icd::covers(*sent, icd::GridBounds::from_grid(*grid));
        });
    EXPECT_TRUE(is_sent) << number;
  }
}

TEST_P(MapQueueLaws, ReplacedGridsAreNotSent) {
  const std::set<std::uint64_t> once{course_.replaced.begin(), course_.replaced.end()};
  EXPECT_EQ(once.size(), course_.replaced.size());
  for (const auto& map : course_.sent) {
    EXPECT_FALSE(map.map.is_grid() && once.contains(map.updates.back()));
  }
}

TEST_P(MapQueueLaws, OverlappingGridsAreSentInOrder) {
  std::map<std::uint64_t, std::size_t> sent_as;  // by number
  for (std::size_t i = 0; i < course_.sent.size(); ++i) {
    for (const auto number : course_.sent[i].updates) sent_as[number] = i;
  }
  for (const auto number : course_.replaced) course_.accepted.erase(number);  // they were not sent themselves
  for (const auto& [older, map] : course_.accepted) {
    for (const auto& [newer, other] : course_.accepted) {
      if (newer < older || !map.is_grid() || !other.is_grid() || map.name != other.name) continue;
      const auto cells =
          cells_in(std::get<icd::OccupancyGrid>(map.msg), std::get<icd::OccupancyGrid>(other.msg));
      const auto& grid = std::get<icd::OccupancyGrid>(map.msg);
      if (!cells || !cells->overlaps({0, 0, grid.width, grid.height})) continue;
      EXPECT_LE(sent_as.at(older), sent_as.at(newer));
    }
  }
}

TEST_P(MapQueueLaws, CloudPointsComeOutCompleteAndInOrder) {
  std::map<std::optional<icd::RobotName>, std::vector<std::uint8_t>> in, out;
  const auto append = [](auto& points, const icd::MapUpdate& map) {
    if (map.is_grid()) return;
    const auto more = points_of(map);
    points[map.name].insert(points[map.name].end(), more.begin(), more.end());
  };
  for (const auto& [number, update] : course_.accepted) append(in, update);
  for (const auto& map : course_.sent) append(out, map.map);
  EXPECT_EQ(in, out);
}

TEST_P(MapQueueLaws, MergesOnlyMergeableCloudsWithinTheLimit) {
  for (const auto& map : course_.sent) {
    if (map.map.is_grid() || map.updates.size() == 1) continue;
    EXPECT_LE(map.map.data.raw_size, kMergeBytes);
    for (const auto number : map.updates) {
      EXPECT_TRUE(mergeable(std::get<icd::PointCloud2>(course_.accepted.at(number).msg),
                            std::get<icd::PointCloud2>(map.map.msg)));
    }
  }
}

TEST_P(MapQueueLaws, SentMapsHaveTheAgeOfTheirOldestUpdate) {
  for (const auto& map : course_.sent) {
    EXPECT_EQ(map.accepted, course_.accepted_at.at(map.updates.front()));
  }
}

INSTANTIATE_TEST_SUITE_P(Courses, MapQueueLaws, testing::Range(std::uint64_t{1}, std::uint64_t{16}));

}  // namespace
}  // namespace adit::queues
