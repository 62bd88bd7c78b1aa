#include <gtest/gtest.h>

#include "queues/map_queue.hpp"
#include "queues/maps.hpp"

namespace adit::queues {
namespace {

QueuedMap queued_map(icd::MapUpdate map) {
  return {.map = std::move(map), .accepted = at(0), .updates = {1}};
}

QueuedMap whole(QueuedMap cloud) {
  cloud.is_whole = true;
  return cloud;
}

const QueuedMap kGrid = queued_map(grid_update("r1", grid(0, 0, 10, 10)));
const QueuedMap kCloud = queued_map(cloud_update("r1", {1}));

Pipelining after(int accepted) {
  Pipelining ahead;
  for (int i = 0; i < accepted; ++i) ahead.on_accepted(false);
  return ahead;
}

bool may_go(const Pipelining& ahead, double now = 1, bool went_ahead = false) {
  return ahead.can_send(kGrid, {.map = kCloud, .arrived = at(1), .went_ahead = went_ahead}, at(now));
}

TEST(Pipelining, AllowedIfTheOrderDoesNotMatter) {
  const QueuedMap other_grid = queued_map(grid_update("r2", grid(0, 0, 10, 10)));
  const QueuedMap merged = queued_map(cloud_update("", {1}));
  const struct {
    const QueuedMap &one, &other;
    bool can_swap;
  } cases[] = {{kGrid, other_grid, true},
               {kGrid, kCloud, true},
               {kCloud, merged, true},
               {kCloud, kCloud, true},
               {kGrid, kGrid, false},
               {kCloud, whole(kCloud), false},
               {whole(kCloud), whole(kCloud), false},
               {whole(kCloud), whole(merged), true}};
  for (const auto& each : cases) {
    EXPECT_EQ(can_swap(each.one, each.other), each.can_swap) << &each - cases;
    EXPECT_EQ(can_swap(each.other, each.one), each.can_swap) << &each - cases;
  }
}

TEST(Pipelining, AllowedAfterSeveralDeliveriesInARow) {
  EXPECT_FALSE(may_go(after(Pipelining::kWell - 1)));
  Pipelining ahead = after(Pipelining::kWell);
  EXPECT_TRUE(may_go(ahead));
  ahead.on_failed(false);
  EXPECT_FALSE(may_go(ahead));
  for (int i = 0; i < Pipelining::kWell; ++i) ahead.on_accepted(false);
  EXPECT_TRUE(may_go(ahead));
}

TEST(Pipelining, AllowedWhileTheAnswerIsNotLate) {
  const double late = std::chrono::duration<double>(Pipelining::kLate).count();
  EXPECT_TRUE(may_go(after(Pipelining::kWell), 1 + late));
  EXPECT_FALSE(may_go(after(Pipelining::kWell), 1.001 + late));
}

TEST(Pipelining, SecondAllowedAfterOneAheadWasDelivered) {
  Pipelining ahead = after(Pipelining::kWell);
  EXPECT_FALSE(may_go(ahead, 1, true)) << "this map is a trial";
  ahead.on_accepted(true);
  EXPECT_TRUE(may_go(ahead, 1, true));
  ahead.on_failed(true);
  for (int i = 0; i < Pipelining::kMostWell; ++i) ahead.on_accepted(false);
  EXPECT_FALSE(may_go(ahead, 1, true)) << "this map is another trial";
  EXPECT_TRUE(may_go(ahead));
}

TEST(Pipelining, ForbiddenForAMapThatFailedBefore) {
  QueuedMap failed = kGrid;
  failed.trial.failures = 1;
  const Pipelining ahead = after(Pipelining::kWell);
  EXPECT_FALSE(ahead.can_send(failed, {.map = kCloud, .arrived = at(1), .went_ahead = false}, at(1)));
  EXPECT_FALSE(ahead.can_send(kCloud, {.map = failed, .arrived = at(1), .went_ahead = false}, at(1)));
}

TEST(Pipelining, BacksOffIfTwoInFlightFail) {
  Pipelining ahead;
  for (int tried = 0, accepted_between = Pipelining::kWell; tried < 10; ++tried) {
    int accepted = 0;
    for (; !may_go(ahead); ++accepted) ahead.on_accepted(false);
    EXPECT_EQ(accepted, accepted_between);
    ahead.on_failed(true);
    accepted_between = std::min(2 * accepted_between, Pipelining::kMostWell);
  }
  for (int i = 0; i < Pipelining::kMostWell; ++i) ahead.on_accepted(false);
  ahead.on_accepted(true);
  ahead.on_failed(false);
  for (int i = 0; i < Pipelining::kWell; ++i) ahead.on_accepted(false);
  EXPECT_TRUE(may_go(ahead)) << "a map was accepted";
}

}  // namespace
}  // namespace adit::queues
