#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "queues/map_queue.hpp"

namespace adit::queues {
namespace {

using Action = MapAction;
using Event = MapEvent;
using State = MapState;

TEST(MapLife, HasEachEventOncePerState) {
  std::set<std::pair<State, Event>> seen;
  for (const MapTransition& row : map_life()) EXPECT_TRUE(seen.emplace(row.from, row.event).second);
}

TEST(MapLife, QueuesAMapAgainUnlessItIsFinished) {
  const std::set back = {Action::PutBack, Action::PutBackApart, Action::PutBackSmaller};
  for (const MapTransition& row : map_life()) {
    EXPECT_EQ(row.to == State::Queued, back.contains(row.action)) << static_cast<int>(row.event);
  }
}

/// Promise 2: no mapped area is lost.
TEST(MapLife, DeletesAFileOnlyIfTheMapIsDeliveredOrHasNoPoint) {
  for (const MapTransition& row : map_life()) {
    EXPECT_EQ(row.to == State::Delivered || row.to == State::Empty, row.action == Action::Forget)
        << static_cast<int>(row.event);
  }
}

TEST(MapLife, DeliversAMapOnlyIfTheCommandPostAcceptsIt) {
  for (const MapTransition& row : map_life()) {
    if (row.to != State::Delivered) continue;
    EXPECT_EQ(row.from, State::InFlight);
    EXPECT_EQ(row.event, Event::Accepted);
  }
}

TEST(MapLifeDeathTest, EndsTheProcessAtAnEventThatIsImpossibleInTheState) {
  EXPECT_DEATH(transition(State::InFlight, Event::Recalled), "assertion failed");
  EXPECT_DEATH(transition(State::Queued, Event::Sent), "assertion failed");
  EXPECT_DEATH(transition(State::Delivered, Event::Failed), "assertion failed");
}

}  // namespace
}  // namespace adit::queues
