#include "queues/rejected_messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "queues/maps.hpp"
#include "queues/marker_queue.hpp"
#include "queues/state_queue.hpp"

namespace adit::queues {
namespace {

icd::StateUpdate state_of(const std::vector<std::string>& names, double x = 0) {
  icd::StateUpdate update;
  icd::Pose pose;
  pose.position.x = x;
  for (const std::string& name : names) update.poses.push_back({*robot(name), pose});
  return update;
}

icd::Marker marker(const std::string& ns, std::int32_t id,
                   icd::MarkerAction action = icd::MarkerAction::Add) {
  icd::Marker marker;
  marker.ns = ns;
  marker.id = id;
  marker.action = action;
  return marker;
}

RejectedMessage item(Message message, std::size_t bytes = 100) {
  RejectedMessage item;
  item.message = std::move(message);
  item.status = 422;
  item.why = "no";
  item.bytes = bytes;
  return item;
}

/// Delivers `message`. Returns the rejected messages that it replaces.
std::vector<std::uint64_t> deliver(RejectedMessages& rejected, const Message& message) {
  auto replaced = rejected.replaced_by(message);
  rejected.mark_replaced(replaced);
  return replaced;
}

TEST(RejectedMessages, TellsIfAMessageReplacesAnother) {
  const Message small = grid_update("ugv1", grid(0, 0, 10, 10)),
                large = grid_update("ugv1", grid(0, 0, 20, 20)),
                others = grid_update("ugv2", grid(0, 0, 20, 20)), cloud = cloud_update("ugv1", {1});
  EXPECT_TRUE(replaces(large, item(small)));
  EXPECT_TRUE(replaces(small, item(small)));
  EXPECT_FALSE(replaces(small, item(large)));
  EXPECT_FALSE(replaces(others, item(small)));
  EXPECT_FALSE(replaces(cloud, item(cloud))) << "no cloud covers another";
  EXPECT_FALSE(replaces(cloud, item(small)));

  const Message one = state_of({"ugv1"}), both = state_of({"ugv1", "ugv2"});
  EXPECT_TRUE(replaces(both, item(one)));
  EXPECT_FALSE(replaces(one, item(both)));
  EXPECT_FALSE(replaces(both, item(small)));

  const Message a = icd::MarkersUpdate{{marker("a", 1)}},
                ab = icd::MarkersUpdate{{marker("a", 1), marker("b", 1)}},
                gone = icd::MarkersUpdate{{marker("a", 1, icd::MarkerAction::Delete)}},
                all_gone = icd::MarkersUpdate{{marker("", 0, icd::MarkerAction::DeleteAll)}};
  EXPECT_TRUE(replaces(ab, item(a)));
  EXPECT_FALSE(replaces(a, item(ab)));
  EXPECT_TRUE(replaces(gone, item(a)));
  EXPECT_TRUE(replaces(all_gone, item(ab)));
  EXPECT_FALSE(replaces(ab, item(all_gone)));
}

TEST(RejectedMessages, MarksMapsThatANewerOneContains) {
  RejectedMessages rejected;
  rejected.add(item(grid_update("ugv1", grid(0, 0, 10, 10))));
  rejected.add(item(cloud_update("ugv1", {1})));
  EXPECT_TRUE(deliver(rejected, grid_update("ugv1", grid(5, 5, 10, 10))).empty());
  EXPECT_EQ(rejected.replaced_by(grid_update("ugv1", grid(0, 0, 30, 30))).size(), 1u);
  EXPECT_FALSE(rejected.find(1)->replaced) << "not before it is marked";
  EXPECT_EQ(deliver(rejected, grid_update("ugv1", grid(0, 0, 30, 30))), std::vector<std::uint64_t>{1});
  EXPECT_TRUE(deliver(rejected, grid_update("ugv1", grid(0, 0, 30, 30))).empty()) << "it was marked before";
  EXPECT_TRUE(rejected.find(1)->replaced);
  EXPECT_FALSE(rejected.find(2)->replaced);
}

TEST(RejectedMessages, AreNotReplacedByAnOlderRetriedGrid) {
  const auto made_at = [](icd::Stamp stamp, std::uint32_t cells) {
    icd::MapUpdate map = grid_update("ugv1", grid(0, 0, cells, cells));
    map.header().stamp = stamp;
    return map;
  };
  RejectedMessages rejected;
  rejected.add(item(made_at(20, 10)));
  EXPECT_TRUE(deliver(rejected, made_at(10, 30)).empty());
  EXPECT_TRUE(rejected.add(item(made_at(10, 30))).empty()) << "also if it is rejected again";
  EXPECT_EQ(deliver(rejected, made_at(30, 30)), (std::vector<std::uint64_t>{1, 2}));
}

TEST(RejectedMessages, AreNotReplacedBitByBitByACreepingWindow) {
  const auto window = [](double x) { return grid_update("ugv1", grid(x, 0, 100, 100)); };
  RejectedMessages rejected;
  rejected.add(item(window(0)));
  EXPECT_EQ(rejected.add(item(window(0.02))), std::vector<std::uint64_t>{1});
  EXPECT_TRUE(rejected.add(item(window(0.04))).empty()) << "40 mm of the first are outside";
  EXPECT_EQ(rejected.replaced_by(window(0.04)), std::vector<std::uint64_t>{3});
  EXPECT_EQ(rejected.replaced_by(window(0.02)), (std::vector<std::uint64_t>{2, 3}));
  RejectedMessage replaced_others = item(window(1));
  replaced_others.bounds = icd::joint_bounds(icd::GridBounds::from_grid(grid(1, 0, 100, 100)),
                                             icd::GridBounds::from_grid(grid(0.98, 0, 100, 100)));
  rejected.add(replaced_others);
  EXPECT_EQ(rejected.replaced_by(window(0.99)), std::vector<std::uint64_t>{4});
  EXPECT_TRUE(rejected.replaced_by(window(1.02)).empty());
}

/// Of 30 x 10 cells; only the ten columns at each end were posted.
QueuedMap with_a_gap() {
  QueuedMap stitched{.map = grid_update("ugv1", grid(0, 0, 30, 10)), .accepted = {}, .updates = {1, 2}};
  for (const double x : {0.0, 2.0})
    stitched.parts.push_back(
        {.map = grid_update("ugv1", grid(x, 0, 10, 10)), .accepted = {}, .updates = {1}});
  stitched.has_gaps = true;
  return stitched;
}

TEST(RejectedMessages, AreNotReplacedByTheGapOfAStitchedGrid) {
  QueuedMap stitched = with_a_gap();
  RejectedMessages rejected;
  rejected.add(item(grid_update("ugv1", grid(1, 0, 10, 10))));  // in the middle
  rejected.add(item(grid_update("ugv1", grid(2, 0, 5, 5))));    // within the second part
  std::vector<std::uint64_t> replaced;
  for (const icd::MapUpdate* const map : delivered_maps(stitched))
    std::ranges::copy(deliver(rejected, *map), std::back_inserter(replaced));
  EXPECT_EQ(replaced, std::vector<std::uint64_t>{2});
  stitched.has_gaps = false;
  ASSERT_EQ(delivered_maps(stitched).size(), 1u);
  EXPECT_EQ(deliver(rejected, *delivered_maps(stitched).front()), std::vector<std::uint64_t>{1});
}

TEST(RejectedMessages, AreRetriedIfTheSentGridHasAGapThere) {
  const auto back = [](double x, std::uint32_t cells) {
    return QueuedMap{
        .map = grid_update("ugv1", grid(x, 0, cells, cells)), .accepted = {}, .updates = {3}, .again = 10};
  };
  const QueuedMap goes = with_a_gap();
  EXPECT_FALSE(replaces(goes, back(1, 10))) << "the grid lies in the gap";
  EXPECT_FALSE(replaces(goes, back(1.8, 5))) << "the grid lies half in the second part";
  EXPECT_TRUE(replaces(goes, back(2, 5))) << "the grid lies in the second part";
}

TEST(RejectedMessages, MarksADeleteAllOlderThanAMarker) {
  RejectedMessages rejected;
  rejected.add(item(icd::MarkersUpdate{{marker("", 0, icd::MarkerAction::DeleteAll)}}));
  EXPECT_TRUE(deliver(rejected, state_of({"ugv1"})).empty());
  EXPECT_EQ(deliver(rejected, icd::MarkersUpdate{{marker("a", 1)}}), std::vector<std::uint64_t>{1});
}

TEST(RejectedMessages, KeepsOneOfEqualMessages) {
  RejectedMessages rejected;
  for (int i = 0; i < 1000; ++i) rejected.add(item(state_of({"ugv1", "ugv2"}, i)));
  EXPECT_EQ(rejected.items().size(), 1);
  EXPECT_EQ(rejected.items().front().number, 1000);
}

TEST(RejectedMessages, IsBounded) {
  RejectedMessages rejected;
  for (std::size_t i = 0; i < 3 * RejectedMessages::kMostItems; ++i)
    rejected.add(item(cloud_update("ugv1", {1})));
  EXPECT_EQ(rejected.items().size(), RejectedMessages::kMostItems);
  EXPECT_EQ(rejected.items().front().number, 2 * RejectedMessages::kMostItems + 1)
      << "the oldest messages are dropped";

  rejected.add(item(cloud_update("ugv1", {1}), RejectedMessages::kMostBytes + 1));
  EXPECT_EQ(rejected.items().size(), 1) << "one message is always kept";
}

TEST(RejectedMessages, GivesEachMessageOutOnce) {
  RejectedMessages rejected;
  rejected.add(item(cloud_update("ugv1", {1})));
  EXPECT_TRUE(rejected.extract(1));
  EXPECT_FALSE(rejected.extract(1));
  EXPECT_EQ(rejected.find(1), nullptr);
}

TEST(StateQueueApart, FindsTheFaultyRobotAndSendsTheOthers) {
  StateQueue queue;
  queue.add(posted(state_of({"ugv1", "ugv2", "ugv3"})), at(0));
  queue.put_back_single(*queue.pop());
  std::vector<std::string> passed;
  for (int i = 0; i < 3; ++i) {
    const auto taken = queue.pop(at(1 + i));
    ASSERT_EQ(taken->update.poses.size(), 1);
    const icd::RobotName& name = taken->update.poses.front().name;
    if (name.text() == "ugv2") {
      queue.give_up(name, at(1 + i));
    } else {
      queue.on_passed(*taken);
      passed.push_back(name.text());
    }
  }
  EXPECT_EQ(passed, (std::vector<std::string>{"ugv1", "ugv3"}));
  EXPECT_TRUE(queue.empty());

  queue.add(posted(state_of({"ugv1", "ugv2", "ugv3"})), at(5));
  const auto together = queue.pop(at(6));
  ASSERT_EQ(together->update.poses.size(), 2) << "accepted poses are sent together again";
  const auto apart = queue.pop(at(20));
  ASSERT_EQ(apart->update.poses.size(), 1);
  EXPECT_EQ(apart->update.poses.front().name.text(), "ugv2");
  queue.on_passed(*apart);
  queue.add(posted(state_of({"ugv1"})), at(21));
  EXPECT_EQ(queue.pop(at(22))->update.poses.size(), 3);
}

TEST(StateQueueApart, RetriesOnlyTheNewestRejectedPose) {
  const icd::StateUpdate rejected_poses = state_of({"ugv1"});
  StateQueue queue;
  queue.add_unless_known(rejected_poses, at(0));
  const auto given_up = queue.pop();
  ASSERT_TRUE(given_up) << "no newer pose is known";
  queue.add_unless_known(rejected_poses, at(1));
  EXPECT_TRUE(queue.empty()) << "the pose is in flight";
  queue.give_up(rejected_poses.poses.front().name, at(1));
  queue.add_unless_known(rejected_poses, at(2));
  const auto again = queue.pop();
  ASSERT_TRUE(again);
  queue.on_passed(*again);
  queue.add_unless_known(rejected_poses, at(3));
  EXPECT_TRUE(queue.empty()) << "the pose was delivered";

  queue.add(posted(rejected_poses), at(4));
  queue.pop();
  queue.add(posted(rejected_poses), at(5));  // a newer one
  queue.give_up(rejected_poses.poses.front().name, at(6));
  queue.on_passed(*queue.pop());
  queue.add_unless_known(rejected_poses, at(7));
  EXPECT_TRUE(queue.empty()) << "a newer pose was delivered";
}

TEST(StateQueueApart, SendsOtherRobotsWhileOneIsOnTrial) {
  StateQueue queue;
  queue.add(posted(state_of({"ugv1", "ugv2"})), at(0));
  queue.give_up(*robot("ugv2"), at(0));
  EXPECT_EQ(queue.pop(at(1))->update.poses.front().name.text(), "ugv1");
  EXPECT_FALSE(queue.empty()) << "ugv2 still has an unsent pose";
  EXPECT_EQ(queue.unsent().size(), 1) << "ugv1 is in flight";
}

TEST(MarkerQueueNarrower, FindsTheFaultyMarker) {
  MarkerQueue queue({.per_message = 64});
  icd::MarkersUpdate update;
  for (int id = 0; id < 64; ++id) update.markers.push_back(marker("a", id));
  queue.add(update, at(0));
  std::vector<std::int32_t> refused;
  std::size_t taken = 0;
  int messages = 0;
  while (auto waiting = queue.pop(0)) {
    ++messages;
    const auto& markers = waiting->update.markers;
    const bool bad = std::ranges::find(markers, 37, &icd::Marker::id) != markers.end();
    if (!bad) {
      queue.on_passed();
      taken += markers.size();
    } else if (markers.size() > 1) {
      queue.put_back_narrower(*waiting);
    } else {
      refused.push_back(markers.front().id);
    }
  }
  EXPECT_EQ(refused, std::vector<std::int32_t>{37});
  EXPECT_EQ(taken, 63);
  EXPECT_LE(messages, 30);
}

TEST(MarkerQueueBehind, SendsOthersFirstAndLosesNothing) {
  MarkerQueue queue({.per_message = 1});
  queue.add({{marker("a", 1)}}, at(0));
  queue.add({{marker("b", 1)}}, at(0));
  const auto first = queue.pop(0);
  queue.requeue_last(*first);
  EXPECT_EQ(queue.pop(0)->update.markers.front().ns, "b");
  const auto again = queue.pop(0);
  EXPECT_EQ(again->update.markers.front().ns, "a");
  EXPECT_EQ(again->updates, 1);
}

TEST(MarkerQueueBehind, SendsAPostponedMarkerAfterTheOthers) {
  MarkerQueue queue({.per_message = 1});
  queue.add({{marker("a", 1), marker("b", 1)}}, at(0));
  queue.requeue_last(*queue.pop(0));
  EXPECT_EQ(queue.pop(0)->updates, 0u) << "only a part of the update was sent";
  ASSERT_TRUE(queue.oldest());
  const auto again = queue.pop(0);
  EXPECT_EQ(again->update.markers.front().ns, "a");
  EXPECT_EQ(again->updates, 1u);
}

TEST(MarkerQueueBehind, KeepsANewerChangeOfThePostponedMarker) {
  MarkerQueue queue({.per_message = 1});
  queue.add({{marker("a", 1)}}, at(0));
  const auto first = queue.pop(0);
  icd::Marker newer = marker("a", 1);
  newer.text = "newer";
  queue.add({{newer}}, at(1));
  queue.requeue_last(*first);
  EXPECT_EQ(queue.count(), 1);
  const auto taken = queue.pop(0);
  EXPECT_EQ(taken->update.markers.front().text, "newer");
  EXPECT_EQ(taken->updates, 2);
}

TEST(MarkerQueueBehind, DoesNotReorderADeleteAll) {
  MarkerQueue queue({.per_message = 1});
  queue.add({{marker("", 0, icd::MarkerAction::DeleteAll), marker("a", 1)}}, at(0));
  for (int round = 0; round < 3; ++round) {
    const auto first = queue.pop(0);
    ASSERT_EQ(first->update.markers.front().action, icd::MarkerAction::DeleteAll);
    queue.requeue_last(*first);
    (void)queue.pop(0);  // the message that is sent before it once
  }
  queue.on_passed();
  EXPECT_EQ(queue.pop(0)->update.markers.front().action, icd::MarkerAction::DeleteAll);
  EXPECT_EQ(queue.pop(0)->update.markers.front().ns, "a") << "also in its own turn";
}

TEST(MarkerQueueBehind, TriesOtherMarkersAheadOfADeleteAll) {
  MarkerQueue queue({.per_message = 1});
  queue.add({{marker("", 0, icd::MarkerAction::DeleteAll), marker("a", 1), marker("b", 1)}}, at(0));
  std::vector<std::string> ahead;
  for (int round = 0; round < 3; ++round) {
    queue.requeue_last(*queue.pop(0));
    const auto other = queue.pop(0);
    EXPECT_TRUE(other->is_ahead);
    EXPECT_EQ(other->updates, 0u) << "the update is still queued";
    ahead.push_back(other->update.markers.front().ns);
  }
  EXPECT_EQ(ahead, (std::vector<std::string>{"a", "b", "a"})) << "each of them may be at fault";
  EXPECT_EQ(queue.count(), 3u);
}

TEST(MarkerQueueBehind, SendsNothingAheadOfALoneDeleteAll) {
  MarkerQueue queue({.per_message = 1});
  queue.add({{marker("", 0, icd::MarkerAction::DeleteAll)}}, at(0));
  queue.requeue_last(*queue.pop(0));
  const auto again = queue.pop(0);
  EXPECT_FALSE(again->is_ahead);
  EXPECT_EQ(again->updates, 1u);
}

/// The poses would be sent to another Command Post, hours later.
TEST(StateQueue, FailedSendDoesNotMakeOldPosesNews) {
  StateQueue queue;
  queue.add(posted(state_of({"ugv1"})), at(0));
  queue.on_passed(*queue.pop());
  queue.add(posted(state_of({"ugv2"})), at(1));
  const auto both = *queue.pop();
  ASSERT_EQ(both.update.poses.size(), 2u);
  queue.put_back(both);
  ASSERT_EQ(queue.unsent().size(), 1u);
  EXPECT_EQ(queue.unsent().front().name.text(), "ugv2");
}

TEST(StateQueue, ForgetsRobotsWithoutNewsIfFull) {
  StateQueue queue;
  icd::StateUpdate many;
  for (std::size_t i = 0; i < StateQueue::kMostRobots; ++i) {
    many.poses.push_back({*robot("r" + std::to_string(i)), {}});
  }
  queue.add(posted(many), at(0));
  const auto under_way = *queue.pop();
  EXPECT_FALSE(queue.has_room_for(state_of({"ugv1"}))) << "the messages in flight may return";
  queue.on_passed(under_way);
  queue.add(posted(state_of({"r7"})), at(1));
  ASSERT_TRUE(queue.has_room_for(state_of({"ugv1"})));
  queue.add(posted(state_of({"ugv1"})), at(2));
  EXPECT_EQ(queue.pop()->update.poses.size(), 2u);
}

}  // namespace
}  // namespace adit::queues
