#include "queues/canvases.hpp"

#include <gmock/gmock.h>

#include "queues/map_queue.hpp"
#include "queues/maps.hpp"
#include "queues/packing.hpp"

namespace adit::queues {
namespace {

class CanvasesTest : public testing::Test {
 protected:
  static icd::MapUpdate window_at(int x, int y, int side = 10, double resolution = 0.5) {
    const auto size = static_cast<std::uint32_t>(side);
    icd::MapUpdate map = grid_update("R1", grid(x * resolution, y * resolution, size, size, resolution));
    map.data = {icd::ChunkedBytes{std::vector<std::uint8_t>(map.data.raw_size, 7)}, icd::Compression::None,
                map.data.raw_size};
    return map;
  }
  void add(icd::MapUpdate map) {
    ++number_;
    if (const auto grows = queue_.canvases().grows(map)) {
      queue_.canvases().on_grown(*grows);
      posted_[grows->first] = grows->second;
    }
    queue_.add(number_, std::move(map), at(static_cast<double>(number_)));
  }
  QueuedMap take_packed() {
    auto next = queue_.pop();
    packed_of(queue_, *next);
    return *std::move(next);
  }
  /// The number of windows that share a message, of two with one up to the right of the other.
  std::size_t go_together(int x, int y) {
    add(window_at(x, y));
    add(window_at(x + 2, y + 2));
    const std::size_t together = take_packed().updates.size();
    while (queue_.count() > 0) take_packed();
    return together;
  }

  /// The same after a first window, which is never stitched.
  std::size_t go_together_from_now_on(int x, int y) {
    go_together(300, 300);
    return go_together(x, y);
  }
  void receive_statuses(int statuses) {
    for (int i = 0; i < statuses; ++i) queue_.canvases().on_status({});
  }

  MapQueue queue_{0};
  Canvases::PostedAreas posted_;
  std::uint64_t number_ = 0;
};

TEST_F(CanvasesTest, KnowSentAndUnsentAreas) {
  EXPECT_EQ(go_together(0, 0), 1) << "no area is known before the first map";
  EXPECT_EQ(go_together(4, 4), 2);
  EXPECT_EQ(go_together(0, 2), 2) << "over a sent area";
  EXPECT_EQ(go_together(-300, 500), 2) << "outside the sent area";
}

TEST_F(CanvasesTest, DoNotKnowAreasSentOnAnotherLattice) {
  add(window_at(0, 0, 40, 0.25));
  take_packed();
  EXPECT_EQ(go_together(5, 5), 1);
  EXPECT_EQ(go_together(6, 6), 1) << "sending a map there does not make the area known";
  EXPECT_EQ(go_together(70, 70), 2) << "an area that was never sent, some tiles away";
}

TEST_F(CanvasesTest, NewRunKnowsMapsSentSinceTheSecondLastStatus) {
  go_together(0, 0);
  receive_statuses(1);
  queue_.canvases().begin_run();
  EXPECT_EQ(go_together_from_now_on(4, 4), 1) << "the status may be older than the map's arrival";
  receive_statuses(2);
  queue_.canvases().begin_run();
  EXPECT_EQ(go_together_from_now_on(4, 4), 2);
}

TEST_F(CanvasesTest, NewRunKnowsMapsInFlightAtTheSecondLastStatus) {
  add(window_at(100, 100));
  const QueuedMap under_way = take_packed();
  const icd::MapUpdate* const maps[] = {&under_way.map};
  queue_.canvases().on_status(maps);
  receive_statuses(1);
  queue_.canvases().begin_run();
  EXPECT_EQ(go_together_from_now_on(102, 102), 1) << "the cells in its corner are unknown";
  receive_statuses(2);
  queue_.canvases().begin_run();
  EXPECT_EQ(go_together_from_now_on(102, 102), 2);
}

TEST_F(CanvasesTest, NewRunCountsMapsSentBeforeARestart) {
  for (const int statuses : {0, 1, 2}) {
    queue_ = MapQueue{0};
    queue_.canvases().restore({{Canvases::kAnyName, Extent::infinite()}});
    receive_statuses(statuses);
    queue_.canvases().begin_run();
    EXPECT_EQ(go_together_from_now_on(4, 4), statuses == 2 ? 2 : 1) << statuses;
  }
}

TEST_F(CanvasesTest, ForgetCellsIfTheRunMayHaveChanged) {
  go_together(0, 0);
  receive_statuses(2);
  queue_.canvases().change_run();
  EXPECT_EQ(go_together_from_now_on(4, 4), 1);
  EXPECT_EQ(go_together(340, 340), 2) << "no map was sent there";
}

TEST_F(CanvasesTest, ResumedRunCountsAllPostedMapsAsSent) {
  go_together(0, 0);
  receive_statuses(2);
  queue_.canvases().begin_run();
  receive_statuses(2);
  queue_.canvases().resume_run();
  EXPECT_EQ(go_together_from_now_on(4, 4), 1);
}

TEST_F(CanvasesTest, ForgetSentCellsAtARestart) {
  go_together(0, 0);
  receive_statuses(2);
  queue_.canvases().begin_run();
  queue_ = MapQueue{0};
  queue_.canvases().restore(posted_);
  go_together(300, 300);
  EXPECT_EQ(go_together(4, 4), 1);
  EXPECT_EQ(go_together(340, 340), 2);
  queue_ = MapQueue{0};
  queue_.canvases().restore({{Canvases::kAnyName, Extent::infinite()}});
  go_together(0, 0);
  EXPECT_EQ(go_together(40, 40), 1);
}

TEST_F(CanvasesTest, KeepCommandPostsApart) {
  queue_.canvases().lead_to("10.100.1.201:8000");
  go_together(0, 0);
  queue_.canvases().lead_to("10.100.2.201:8000");
  add(window_at(100, 100));
  take_packed();
  EXPECT_EQ(go_together(0, 0), 2) << "this Command Post has no cells there";
  queue_.canvases().lead_to("10.100.1.201:8000");
  go_together(200, 200);
  EXPECT_EQ(go_together(0, 0), 1);
}

TEST_F(CanvasesTest, RunAtAnotherCommandPostChangesNothingHere) {
  queue_.canvases().restore({{"R1", extent_of(grid(-1000, -1000, 100, 100))}});
  queue_.canvases().lead_to("10.100.1.201:8000");
  go_together(0, 0);
  queue_.canvases().lead_to("10.100.2.201:8000");
  receive_statuses(2);
  queue_.canvases().begin_run();
  go_together(100, 100);
  EXPECT_EQ(go_together(0, 0), 2);
  EXPECT_EQ(go_together(-1990, -1990), 2);
  queue_.canvases().lead_to("10.100.1.201:8000");
  go_together(200, 200);
  EXPECT_EQ(go_together(0, 0), 1);
  EXPECT_EQ(go_together(-1990, -1990), 1) << "from an earlier process";
}

TEST_F(CanvasesTest, DoNotKnowCellsOfAFailedTry) {
  go_together(0, 0);
  add(window_at(4, 4));
  QueuedMap failed = take_packed();
  ++failed.trial.failures;
  queue_.put_back(std::move(failed));
  add(window_at(6, 6));
  add(window_at(8, 8));
  EXPECT_EQ(take_packed().updates.size(), 1) << "the failed map goes alone";
  EXPECT_EQ(take_packed().updates.size(), 1) << "a corner between the others lies in its tile";
}

TEST_F(CanvasesTest, SplitAFailedMapWithGapsIntoItsParts) {
  go_together(0, 0);
  add(window_at(4, 4));
  add(window_at(6, 6));
  QueuedMap both = take_packed();
  ASSERT_TRUE(both.has_gaps);
  queue_.put_back(std::move(both));
  EXPECT_EQ(queue_.count(), 2) << "a failed stitched map returns as its parts";
  EXPECT_EQ(take_packed().parts.size(), 2);
}

TEST_F(CanvasesTest, ForgetTheOldestAtTheMemoryLimit) {
  queue_.canvases() = Canvases{8};
  go_together(0, 0);
  EXPECT_EQ(go_together(3, 3), 2);
  for (int i = 1; i < 12; ++i) go_together(100 * i, 0);
  EXPECT_EQ(go_together(1100, 2), 2);
  EXPECT_EQ(go_together(3, 3), 1);
  for (int i = 0; i < 600; ++i) {
    queue_.add(1, grid_update("x" + std::to_string(i), grid(0, 0, 4, 4)), at(1));
    auto next = queue_.pop();
    EXPECT_TRUE(!next->ground || i <= static_cast<int>(Canvases::kMostNames));
  }
}

TEST_F(CanvasesTest, IgnoreWholeTurnedAndOversizedGrids) {
  add(window_at(0, 0));
  EXPECT_TRUE(take_packed().ground);
  add(window_at(-1, -1, 12));
  EXPECT_FALSE(take_packed().ground) << "it contains every sent area";
  add(window_at(4, 4));
  EXPECT_TRUE(take_packed().ground);
  auto turned = window_at(0, 0);
  std::get<icd::OccupancyGrid>(turned.msg).origin.orientation = {0, 0, 0.6, 0.8};
  add(turned);
  EXPECT_FALSE(take_packed().ground);
  queue_.add(99, grid_update("R1", grid(-500, -500, 3000, 3000)), at(99));
  EXPECT_FALSE(queue_.pop()->ground);
}

TEST(ExtentOfAGrid, HoldsItsCells) {
  EXPECT_EQ(extent_of(grid(1, 2, 10, 20, 0.5)), (Extent{0.5, 1.5, 6.5, 12.5}));
  auto turned = grid(0, 0, 10, 20, 1);
  turned.origin.orientation = {0, 0, 1, 0};
  EXPECT_TRUE(extent_of(turned).holds({-10, -20, 0, 0}));
  EXPECT_EQ(extent_of(grid(1e308, 0, 4'000'000'000, 1, 1e300)), Extent::infinite());
}

}  // namespace
}  // namespace adit::queues
