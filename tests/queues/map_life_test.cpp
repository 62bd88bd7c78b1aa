#include <gmock/gmock.h>

#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "project_files.hpp"
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

std::string_view words(State state) {
  switch (state) {
    case State::Queued:
      return "queued";
    case State::Packing:
      return "packing";
    case State::Packed:
      return "packed";
    case State::InFlight:
      return "in flight";
    case State::Delivered:
      return "delivered";
    case State::Rejected:
      return "rejected";
    case State::Damaged:
      return "damaged";
    case State::Empty:
      return "empty";
  }
  return "";
}

std::string_view words(Event event) {
  switch (event) {
    case Event::Chosen:
      return "its turn";
    case Event::Packed:
      return "packed";
    case Event::NotPacked:
      return "the worker failed";
    case Event::NotStitched:
      return "its parts cannot be stitched";
    case Event::Damaged:
      return "its data, or that of a part, is damaged";
    case Event::SkippedPiece:
      return "no valid point in this piece; another one follows";
    case Event::SkippedLast:
      return "no valid point; no piece follows";
    case Event::Recalled:
      return "the map before it failed, or the Command Post or the run is another one";
    case Event::TooLarge:
      return "too large for one message";
    case Event::Sent:
      return "sent";
    case Event::AcceptedPiece:
      return "2xx; another piece follows";
    case Event::Accepted:
      return "2xx";
    case Event::Failed:
      return "to be retried, or pieces before it may be lost";
    case Event::RejectedParts:
      return "rejected, and it has parts";
    case Event::Rejected:
      return "rejected";
  }
  return "";
}

std::string_view words(Action action) {
  switch (action) {
    case Action::Nothing:
      return "-";
    case Action::PutBack:
      return "queued as the sender's first, unless a newer map replaces it";
    case Action::PutBackApart:
      return "each part is queued by itself";
    case Action::PutBackSmaller:
      return "its halves are queued, or it is with smaller pieces";
    case Action::Forget:
      return "its file is deleted";
    case Action::Reject:
      return "the rejected messages store it, then its file is deleted";
    case Action::SetAside:
      return "its file is renamed; the other parts are queued by themselves";
  }
  return "";
}

TEST(MapLife, MatchesTheTableOfTheReadme) {
  std::string table = "| state | event | next state | effect |\n| --- | --- | --- | --- |\n";
  for (const MapTransition& row : map_life()) {
    table.append("| ").append(words(row.from)).append(" | ").append(words(row.event)).append(" | ");
    table.append(words(row.to)).append(" | ").append(words(row.action)).append(" |\n");
  }
  EXPECT_THAT(project_text("firmware/flow/forward/README.md"), testing::HasSubstr("\n\n" + table + "\n"));
}

}  // namespace
}  // namespace adit::queues
