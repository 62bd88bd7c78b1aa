#include "queues/map_queue.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "queues/maps.hpp"

namespace adit::queues {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;

constexpr std::size_t kPlenty = 1u << 20;

const auto kSmall = grid(0, 0, 10, 10);
const auto kLarge = grid(-1, -1, 80, 80);
const auto kElsewhere = grid(100, 100, 10, 10);

TEST(MapQueue, SendsInOrderOfArrival) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kSmall), at(1));
  queue.add(2, cloud_update("R2", {1}), at(2));
  queue.add(3, grid_update("", kSmall), at(3));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(2));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(3));
  EXPECT_FALSE(queue.pop());
}

TEST(MapQueue, SendsAMapThatGoesLastAfterAllOthers) {
  MapQueue queue{kPlenty};
  queue.restore(1, cloud_update("R1", {1}), at(1), {}, PackingRule::Last);
  queue.restore(2, cloud_update("R1", {2}), at(1));
  queue.restore(3, grid_update("R2", kSmall), at(1), {}, PackingRule::LastAsItIs);
  queue.restore(4, grid_update("R2", kElsewhere), at(1));
  auto resting = *queue.pop(at(2));
  EXPECT_THAT(resting.updates, ElementsAre(2));
  resting.trial.rests_until = at(100);
  resting.trial.failed = at(2);
  queue.put_back(resting);
  EXPECT_THAT(queue.pop(at(3))->updates, ElementsAre(4));
  EXPECT_THAT(queue.pop(at(3))->updates, ElementsAre(2)) << "it rests, but it is not the last";
  queue.add(5, cloud_update("R1", {3}), at(4));
  EXPECT_THAT(queue.pop(at(5))->updates, ElementsAre(5)) << "not merged with the one that goes alone";
  EXPECT_THAT(queue.pop(at(5))->updates, ElementsAre(1));
  EXPECT_THAT(queue.pop(at(5))->updates, ElementsAre(3));
}

TEST(MapQueue, CoveringGridInheritsPlaceAndAge) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kSmall), at(1));
  queue.add(2, grid_update("R2", kSmall), at(2));
  EXPECT_THAT(queue.add(3, grid_update("R1", kLarge), at(3)).numbers, ElementsAre(1));
  EXPECT_EQ(queue.count(), 2);
  const auto first = queue.pop();
  EXPECT_THAT(first->updates, ElementsAre(1, 3));
  EXPECT_EQ(std::get<icd::OccupancyGrid>(first->map.msg), kLarge);
  EXPECT_EQ(first->accepted, at(1));
}

TEST(MapQueue, ReportsEachReplacedUpdateOnce) {
  MapQueue queue{kPlenty};
  EXPECT_THAT(queue.add(1, grid_update("R1", kSmall), at(1)).numbers, IsEmpty());
  EXPECT_THAT(queue.add(2, grid_update("R1", kSmall), at(2)).numbers, ElementsAre(1));
  EXPECT_THAT(queue.add(3, grid_update("R1", kSmall), at(3)).numbers, ElementsAre(2));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1, 2, 3));
}

TEST(MapQueue, KeepsAGridThatIsNotCovered) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kElsewhere), at(1));
  EXPECT_THAT(queue.add(2, grid_update("R1", kLarge), at(2)).numbers, IsEmpty());
  EXPECT_EQ(queue.count(), 2);
}

TEST(MapQueue, KeepsAGridOfAnotherRobot) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kSmall), at(1));
  EXPECT_THAT(queue.add(2, grid_update("R2", kLarge), at(2)).numbers, IsEmpty());
  EXPECT_THAT(queue.add(3, grid_update("", kLarge), at(3)).numbers, IsEmpty());
  EXPECT_EQ(queue.count(), 3);
}

TEST(MapQueue, ReplacesAllCoveredGrids) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kSmall), at(1));
  queue.add(2, grid_update("R1", grid(1, 1, 10, 10)), at(2));
  EXPECT_THAT(queue.add(3, grid_update("R1", kLarge), at(3)).numbers, ElementsAre(1, 2));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1, 2, 3));
}

/// A window whose origin is off by millimetres.
icd::MapUpdate window(double x, double y = 0, double z = 0) {
  auto any = grid(x / 1000, y / 1000, 200, 200);
  any.origin.position.z = z / 1000;
  any.origin.orientation.z = x * 1e-9;
  return grid_update("R1", any);
}

TEST(MapQueue, ReplacesGridsWhoseOriginIsCorrected) {
  MapQueue queue{kPlenty};
  for (int i = 0; i < 100; ++i)
    queue.add(static_cast<std::uint64_t>(i), window(13 * (i % 2), -13 * (i / 2 % 2), i % 3), at(i));
  EXPECT_EQ(queue.count(), 1) << "each replaced the one before";
  EXPECT_EQ(queue.pop()->updates.size(), 100);
}

TEST(MapQueue, KeepsWhatACreepingWindowLeavesBehind) {
  MapQueue queue{kPlenty};
  EXPECT_TRUE(queue.add(1, window(0), at(1)).numbers.empty());
  EXPECT_THAT(queue.add(2, window(10), at(2)).numbers, ElementsAre(1));
  EXPECT_THAT(queue.add(3, window(20), at(3)).numbers, ElementsAre(2));
  EXPECT_THAT(queue.add(4, window(30), at(4)).numbers, IsEmpty()) << "30 mm of the first are outside";
  EXPECT_THAT(queue.add(5, window(40), at(5)).numbers, ElementsAre(4));
  EXPECT_FALSE(queue.replaces_any(window(40 + 20)));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1, 2, 3));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(4, 5));
}

TEST(MapQueue, KeepsWhatAFailedGridReplaced) {
  MapQueue queue{kPlenty};
  queue.add(1, window(0), at(1));
  queue.add(2, window(20), at(2));
  auto failed = *queue.pop();
  queue.add(3, window(40), at(3));
  EXPECT_FALSE(queue.absorb(failed)) << "40 mm of the first are outside";
  EXPECT_THAT(queue.put_back(failed).numbers, IsEmpty());
  failed = *queue.pop();
  queue.add(4, window(5), at(4));
  EXPECT_TRUE(queue.absorb(failed));
  const ReplacedMaps replaced = queue.put_back(failed);
  EXPECT_THAT(replaced.numbers, ElementsAre(2));
  ASSERT_TRUE(replaced.bounds);
  EXPECT_EQ(replaced.bounds->first, 4);
  EXPECT_NEAR(replaced.bounds->second.high.x, 10.015, 1e-6);
}

TEST(MapQueue, KeepsWhatThePartsOfAStitchedGridReplaced) {
  MapQueue queue{kPlenty};
  const auto tile = [](double x, double left) { return grid_update("R1", grid(x - left / 1000, 0, 20, 20)); };
  queue.add(1, tile(0, 20), at(1));
  queue.add(2, tile(0, 0), at(2));
  queue.add(3, tile(1, 0), at(3));
  auto failed = *queue.pop();
  ASSERT_THAT(failed.updates, ElementsAre(1, 2, 3));
  EXPECT_EQ(queue.put_back(failed).numbers.size(), 0);
  EXPECT_TRUE(queue.replaces_any(grid_update("R1", grid(0, 0, 40, 20))));
  EXPECT_FALSE(queue.replaces_any(grid_update("R1", grid(0.01, 0, 40, 20))))
      << "30 mm of the first are outside";
  // The whole replaces a map that was sent before it. Then its parts are queued singly.
  failed = *queue.pop();
  QueuedMap older{grid_update("R1", grid(1.02, 0, 20, 20)), at(0), {0}};
  queue.put_back(failed);
  const ReplacedMaps replaced = queue.put_back(older);
  ASSERT_THAT(replaced.numbers, ElementsAre(0));
  ASSERT_TRUE(replaced.bounds);
  EXPECT_EQ(replaced.bounds->first, 3) << "the last part stands for it after a restart";
  EXPECT_NEAR(replaced.bounds->second.high.x, 1.02, 1e-9) << "from the last part's own origin";
  queue.put_back_single(*queue.pop());
  EXPECT_EQ(queue.count(), 2);
  EXPECT_FALSE(queue.replaces_any(grid_update("R1", grid(0.99, 0, 20, 20))))
      << "30 mm of the older are outside";
}

TEST(MapQueue, NamesBoundsThatHaveToBeStored) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kSmall), at(1));
  EXPECT_FALSE(queue.add(2, grid_update("R1", kLarge), at(2)).bounds) << "its own bounds";
  queue.add(3, window(0), at(3));
  const auto bounds = queue.add(4, window(20), at(4)).bounds;
  ASSERT_TRUE(bounds);
  EXPECT_EQ(bounds->first, 4);
  EXPECT_NEAR(bounds->second.low.x, -0.02, 1e-6);

  MapQueue restarted{kPlenty};
  restarted.restore(4, window(20), at(5), bounds->second);
  EXPECT_FALSE(restarted.replaces_any(window(40)));
  EXPECT_TRUE(restarted.replaces_any(window(20)));
}

TEST(MapQueue, NeverSendsOldCellsAfterNewerOnes) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kSmall), at(1));
  queue.add(2, grid_update("R2", kSmall), at(2));
  queue.add(3, grid_update("R1", grid(0.2, 0.2, 200, 200)),
            at(3));  // overlaps the next grid, but is not covered
  queue.add(4, grid_update("R1", kLarge), at(4));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(3));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(2)) << "R2's turn";
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1, 4));
}

TEST(MapQueue, MergesConsecutiveCloudsOfARobot) {
  MapQueue queue{kPlenty};
  queue.add(1, cloud_update("R1", {1, 2}), at(1));
  queue.add(2, grid_update("R2", kSmall), at(2));
  queue.add(3, cloud_update("R1", {3}), at(3));
  const auto merged = queue.pop();
  EXPECT_THAT(merged->updates, ElementsAre(1, 3));
  EXPECT_THAT(points_of(merged->map), ElementsAre(1, 2, 3));
  EXPECT_EQ(merged->map.data.raw_size, 36);
  EXPECT_EQ(merged->accepted, at(1));
  EXPECT_EQ(queue.count(), 1);
}

TEST(MapQueue, SplitsFailedMergedCloudsAndSendsEachAlone) {
  MapQueue queue{kPlenty};
  queue.add(1, cloud_update("R1", {1}), at(1));
  queue.add(2, cloud_update("R1", {2}), at(2));
  auto merged = *queue.pop();
  queue.add(3, cloud_update("R1", {3}), at(3));
  queue.put_back(std::move(merged));
  merged = *queue.pop();
  EXPECT_THAT(merged.updates, ElementsAre(1, 2, 3));
  queue.put_back_single(std::move(merged));
  queue.add(4, cloud_update("R1", {4}), at(4));
  queue.add(5, cloud_update("R1", {5}), at(5));
  for (const float point : {1.0F, 2.0F, 3.0F}) {
    const auto part = queue.pop();
    EXPECT_THAT(part->updates, ElementsAre(static_cast<std::uint64_t>(point)));
    EXPECT_THAT(points_of(part->map), ElementsAre(point));
  }
  EXPECT_THAT(queue.pop()->updates, ElementsAre(4, 5)) << "later maps are merged as usual";
  EXPECT_EQ(queue.bytes(), 0);
}

TEST(MapQueue, HalvesMergedCloudsThatAreTooLarge) {
  MapQueue queue{kPlenty};
  for (std::uint8_t i = 1; i <= 5; ++i) queue.add(i, cloud_update("R1", {i}), at(i));
  queue.put_back_halves(*queue.pop());
  queue.add(6, cloud_update("R1", {6}), at(6));
  queue.put_back_halves(*queue.pop());
  EXPECT_THAT(points_of(queue.pop()->map), ElementsAre(1, 2));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(3));
  const auto second = queue.pop();
  EXPECT_THAT(second->updates, ElementsAre(4, 5));
  EXPECT_THAT(points_of(second->map), ElementsAre(4, 5));
  EXPECT_EQ(second->map.data.raw_size, 24);
  EXPECT_THAT(queue.pop()->updates, ElementsAre(6)) << "not joined with a half";
  EXPECT_EQ(queue.bytes(), 0);
}

TEST(MapQueue, GoesOnWithTheRowsThatAnOlderGridWouldHaveSentNext) {
  constexpr int kRows = 40;
  MapQueue queue{kPlenty};
  std::set<long> sent;  // rows, by their place
  double y = 0;
  for (int i = 1; i <= 7; ++i) {
    // It grows at its lower side, and SLAM corrects its origin.
    y -= 0.05;
    auto newer = grid(0.01 * (i % 2), y, 8, static_cast<std::uint32_t>(kRows + i));
    const double turn = 0.0001 * i;
    newer.origin.orientation = {0, 0, std::sin(turn), std::cos(turn)};
    queue.add(static_cast<std::uint64_t>(i), grid_update("R1", newer), at(i));
    auto next = *queue.pop();
    shrink(next, 5);
    const auto rows = rows_of(next);
    const long first = std::lround(rows.origin.position.y / 0.05);
    for (long row = first; row < first + rows.height; ++row) sent.insert(row);
    ASSERT_TRUE(next_piece(next));
    queue.put_back(std::move(next));
  }
  for (long row = 0; row < kRows; ++row) EXPECT_TRUE(sent.contains(row)) << row;
  auto last = *queue.pop();
  std::size_t cells = last.piece.delivered;
  do cells += std::size_t{rows_of(last).height} * 8;
  while (next_piece(last));
  EXPECT_EQ(cells, last.map.data.raw_size) << "the newest grid is sent as a whole";
}

TEST(Cuts, ShowASizeAfterThreeAtAboutTheSameByteWhileOthersAreDelivered) {
  Cuts cuts;
  EXPECT_FALSE(cuts.check(1'000'000, 10));
  EXPECT_FALSE(cuts.check(1'000'000, 10)) << "nothing was delivered meanwhile";
  EXPECT_FALSE(cuts.check(1'100'000, 11));
  EXPECT_TRUE(cuts.check(950'000, 12));
  Cuts elsewhere;
  std::uint64_t delivered = 0;
  for (const std::size_t at : {1'000'000, 500'000, 1'000'000, 700'000})
    EXPECT_FALSE(elsewhere.check(at, ++delivered)) << "a link that fails";
}

TEST(MapQueue, SendsGridsAloneWhoseWholeIsTooLarge) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", grid(0, 0, 20, 20)), at(1));
  queue.add(2, grid_update("R1", grid(1, 0, 20, 20)), at(2));
  queue.put_back_halves(*queue.pop());
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(2));
}

TEST(MapQueue, MergedCloudsHaveTheNewersHeader) {
  auto older = cloud_update("R1", {1}), newer = cloud_update("R1", {2});
  older.header().stamp = 10;
  newer.header().stamp = 11;
  EXPECT_THAT(merge(older, newer).header().stamp, Optional(11.0));
}

TEST(MapQueue, MergesWithinItsLimitAndInOrder) {
  MapQueue queue{36};  // three points
  queue.add(1, cloud_update("R1", {1, 2}), at(1));
  queue.add(2, cloud_update("R1", {3, 4}), at(2));
  queue.add(3, cloud_update("R1", {5}), at(3));  // would fit, but must not go before 2
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(2, 3));
}

TEST(MapQueue, MergesNoCloudsPastOneThatDoesNotFit) {
  auto other = icd::xyz();
  other.is_bigendian = true;
  MapQueue queue{kPlenty};
  queue.add(1, cloud_update("R1", {1}), at(1));
  queue.add(2, cloud_update("R1", {2}, other), at(2));
  queue.add(3, cloud_update("R1", {3}), at(3));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(2));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(3));
}

TEST(MapQueue, MergesNoPackedCloud) {
  auto packed = cloud_update("R1", {2});
  packed.data.compression = icd::Compression::Gzip;
  MapQueue queue{kPlenty};
  queue.add(1, cloud_update("R1", {1}), at(1));
  queue.put_back({packed, at(0), {0}});
  queue.add(2, cloud_update("R1", {3}), at(2));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(0));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1, 2));
}

TEST(MapQueue, TellsWhichCloudsCanBeMerged) {
  const auto plain = icd::xyz();
  auto step = plain, fields = plain, bytes = plain, moved = plain, still = plain;
  step.point_step = 16;
  fields.fields[2].name = "Z";
  bytes.is_bigendian = true;
  moved.origin = icd::Pose{{1, 0, 0}, {}};
  still.origin = icd::Pose{};  // ICD 6.3.2: equals no origin
  EXPECT_TRUE(mergeable(plain, plain));
  EXPECT_TRUE(mergeable(plain, still));
  EXPECT_FALSE(mergeable(plain, step));
  EXPECT_FALSE(mergeable(plain, fields));
  EXPECT_FALSE(mergeable(plain, bytes));
  EXPECT_FALSE(mergeable(plain, moved));
}

TEST(MapQueue, PutsAFailedMapFirstOfItsSender) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kSmall), at(1));
  queue.add(2, cloud_update("R2", {1}), at(2));
  auto failed = *queue.pop();
  queue.add(3, grid_update("R1", kElsewhere), at(3));
  EXPECT_FALSE(queue.absorb(failed));
  EXPECT_THAT(queue.put_back(failed).numbers, ElementsAre());
  EXPECT_THAT(queue.pop()->updates, ElementsAre(2)) << "a failed try counts as a turn";
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(3));
}

TEST(MapQueue, DropsAFailedGridThatANewerOneCovers) {
  MapQueue queue{kPlenty};
  queue.add(1, grid_update("R1", kSmall), at(1));
  auto failed = *queue.pop();
  queue.add(2, cloud_update("R2", {1}), at(2));
  queue.add(3, grid_update("R1", kLarge), at(3));
  EXPECT_TRUE(queue.absorb(failed));
  EXPECT_THAT(queue.put_back(failed).numbers, ElementsAre(1)) << "the map is no longer needed";
  EXPECT_EQ(queue.count(), 2);
  EXPECT_THAT(queue.pop()->updates, ElementsAre(2)) << "R2's turn";
  const auto heir = queue.pop();
  EXPECT_THAT(heir->updates, ElementsAre(1, 3));
  EXPECT_EQ(heir->accepted, at(1));
  EXPECT_EQ(std::get<icd::OccupancyGrid>(heir->map.msg), kLarge);
}

QueuedMap sent_again(std::uint64_t number, const icd::OccupancyGrid& grid, icd::Stamp stamp) {
  QueuedMap map{grid_update("R1", grid), at(9), {number}};
  map.again = stamp;
  return map;
}

TEST(MapQueue, RetriesByHandKeepTheirOrder) {
  MapQueue queue{kPlenty};
  EXPECT_THAT(queue.put_back(sent_again(3, kSmall, 30)).numbers, IsEmpty());
  EXPECT_THAT(queue.put_back(sent_again(1, kLarge, 10)).numbers, IsEmpty());
  EXPECT_THAT(queue.put_back(sent_again(2, kLarge, 20)).numbers, IsEmpty());
  for (const std::uint64_t number : {1, 2, 3}) EXPECT_THAT(queue.pop()->updates, ElementsAre(number));
}

TEST(MapQueue, GridThatAbsorbsARetryStandsForIt) {
  MapQueue queue{kPlenty};
  queue.add(1, window(0), at(1));
  QueuedMap retry{window(20), at(9), {2}};
  retry.again = 10;
  const auto absorbed = queue.absorb(retry);
  ASSERT_TRUE(absorbed && absorbed->bounds);
  EXPECT_EQ(absorbed->bounds->first, 1);
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1));
  queue.add(3, window(0), at(3));
  queue.absorb(retry);
  EXPECT_FALSE(queue.replaces_any(window(-10))) << "30 mm of the retry are outside";
}

// The clock was set back. Guards against a defect in which the older grid won the shared area (the
// simulation's seed 60002763).
TEST(MapQueue, OfEqualStampsTheLaterRetryIsNewer) {
  MapQueue queue{kPlenty};
  EXPECT_THAT(queue.put_back(sent_again(1, kLarge, 10)).numbers, IsEmpty());
  EXPECT_FALSE(queue.absorb(sent_again(2, kSmall, 10)));
  EXPECT_THAT(queue.put_back(sent_again(2, kSmall, 10)).numbers, IsEmpty());
  for (const std::uint64_t number : {1, 2}) EXPECT_THAT(queue.pop()->updates, ElementsAre(number));
  queue.put_back(sent_again(2, kLarge, 10));
  EXPECT_TRUE(queue.absorb(sent_again(1, kSmall, 10)));
}

TEST(MapQueue, RetryByHandSendsACloudFirstOfItsSender) {
  MapQueue queue{0};
  queue.add(7, cloud_update("R1", {1}), at(1));
  QueuedMap map{cloud_update("R1", {2}), at(9), {1}, {}, PackingRule::Alone};
  map.again = 10;
  queue.put_back(map);
  for (const std::uint64_t number : {1, 7}) EXPECT_THAT(queue.pop()->updates, ElementsAre(number));
}

TEST(MapQueue, RetryByHandIsOlderThanNeverRejectedMaps) {
  MapQueue queue{kPlenty};
  queue.add(7, grid_update("R1", kSmall), at(1));
  auto failed = *queue.pop();
  queue.put_back(sent_again(1, kLarge, 10));
  EXPECT_THAT(queue.put_back(failed).numbers, IsEmpty());
  EXPECT_THAT(queue.pop()->updates, ElementsAre(1));
  EXPECT_THAT(queue.pop()->updates, ElementsAre(7));
}

TEST(MapQueue, CountsItsMemory) {
  MapQueue queue{kPlenty};
  EXPECT_EQ(queue.bytes(), 0);
  queue.add(1, cloud_update("R1", {1, 2, 3}), at(1));
  EXPECT_GE(queue.bytes(), 36);
  queue.add(2, grid_update("R1", kSmall), at(2));
  queue.add(3, grid_update("R1", kSmall), at(3));
  auto taken = *queue.pop();
  queue.put_back(taken);
  while (queue.pop()) {
  }
  EXPECT_EQ(queue.bytes(), 0);
}

TEST(MapQueue, StaysFastInAFloodOfTinyClouds) {
  MapQueue queue{kPlenty / 4};
  const auto tiny = cloud_update("R1", {1});
  for (std::uint64_t i = 0; i < 30'000; ++i) queue.add(i, tiny, at(1));
  EXPECT_EQ(queue.pop()->updates.size(), kPlenty / 4 / 12);
}

TEST(MapQueue, TellsIfAMapMergesIntoTheLastOfItsSender) {
  MapQueue queue{1000};
  EXPECT_FALSE(queue.can_join_last(grid_update("R1", grid(0, 0, 4, 4))));
  queue.add(1, grid_update("R1", grid(0, 0, 4, 4)), at(1));
  EXPECT_TRUE(queue.can_join_last(grid_update("R1", grid(0.2, 0, 4, 4))));
  EXPECT_FALSE(queue.can_join_last(grid_update("R1", grid(0.2, 0, 4, 4, 0.1))))
      << "the grid has another lattice";
  EXPECT_FALSE(queue.can_join_last(grid_update("R2", grid(0.2, 0, 4, 4))));
  queue.put_back_single(*[&] {
    queue.add(2, grid_update("R1", grid(0.2, 0, 4, 4)), at(2));
    return queue.pop();
  }());
  EXPECT_FALSE(queue.can_join_last(grid_update("R1", grid(0.4, 0, 4, 4)))) << "the queued grid is sent alone";

  auto turned = icd::xyz();
  turned.is_bigendian = true;
  queue.add(3, cloud_update("R1", {1}), at(3));
  EXPECT_TRUE(queue.can_join_last(cloud_update("R1", {2})));
  EXPECT_FALSE(queue.can_join_last(cloud_update("R1", {2}, turned)));
  EXPECT_FALSE(queue.can_join_last(cloud_update("", {2})));
}

}  // namespace
}  // namespace adit::queues
