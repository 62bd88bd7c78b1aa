#include "lanes/rejected_messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "lanes/maps.hpp"
#include "lanes/marker_lane.hpp"
#include "lanes/state_lane.hpp"

namespace adit::lanes {
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

/// Those that it replaces, now that the Command Post took it.
std::vector<std::uint64_t> taken(RejectedMessages& rejected, const Message& message) {
  auto replaced = rejected.replaced_by(message);
  rejected.mark_replaced(replaced);
  return replaced;
}

TEST(RejectedMessages, KnowsWhatOvertakesAnother) {
  const Message small = grid_update("ugv1", grid(0, 0, 10, 10)),
                large = grid_update("ugv1", grid(0, 0, 20, 20)),
                others = grid_update("ugv2", grid(0, 0, 20, 20)), cloud = cloud_update("ugv1", {1});
  EXPECT_TRUE(replaces(large, small));
  EXPECT_TRUE(replaces(small, small));
  EXPECT_FALSE(replaces(small, large));
  EXPECT_FALSE(replaces(others, small));
  EXPECT_FALSE(replaces(cloud, cloud)) << "nothing covers a cloud";
  EXPECT_FALSE(replaces(cloud, small));

  const Message one = state_of({"ugv1"}), both = state_of({"ugv1", "ugv2"});
  EXPECT_TRUE(replaces(both, one));
  EXPECT_FALSE(replaces(one, both));
  EXPECT_FALSE(replaces(both, small));

  const Message a = icd::MarkersUpdate{{marker("a", 1)}},
                ab = icd::MarkersUpdate{{marker("a", 1), marker("b", 1)}},
                gone = icd::MarkersUpdate{{marker("a", 1, icd::MarkerAction::Delete)}},
                all_gone = icd::MarkersUpdate{{marker("", 0, icd::MarkerAction::DeleteAll)}};
  EXPECT_TRUE(replaces(ab, a));
  EXPECT_FALSE(replaces(a, ab));
  EXPECT_TRUE(replaces(gone, a));
  EXPECT_TRUE(replaces(all_gone, ab));
  EXPECT_FALSE(replaces(ab, all_gone));
}

TEST(RejectedMessages, MarksWhatSomethingNewerSaysAllOf) {
  RejectedMessages rejected;
  rejected.add(item(grid_update("ugv1", grid(0, 0, 10, 10))));
  rejected.add(item(cloud_update("ugv1", {1})));
  EXPECT_TRUE(taken(rejected, grid_update("ugv1", grid(5, 5, 10, 10))).empty());
  EXPECT_EQ(rejected.replaced_by(grid_update("ugv1", grid(0, 0, 30, 30))).size(), 1u);
  EXPECT_FALSE(rejected.find(1)->replaced) << "not before it is marked";
  EXPECT_EQ(taken(rejected, grid_update("ugv1", grid(0, 0, 30, 30))), std::vector<std::uint64_t>{1});
  EXPECT_TRUE(taken(rejected, grid_update("ugv1", grid(0, 0, 30, 30))).empty()) << "it was marked before";
  EXPECT_TRUE(rejected.find(1)->replaced);
  EXPECT_FALSE(rejected.find(2)->replaced);
}

TEST(RejectedMessages, IsNotOvertakenByAnOlderGridThatIsSentAgain) {
  const auto made_at = [](icd::Stamp stamp, std::uint32_t cells) {
    icd::MapUpdate map = grid_update("ugv1", grid(0, 0, cells, cells));
    map.header().stamp = stamp;
    return map;
  };
  RejectedMessages rejected;
  rejected.add(item(made_at(20, 10)));
  EXPECT_TRUE(taken(rejected, made_at(10, 30)).empty());
  EXPECT_TRUE(rejected.add(item(made_at(10, 30))).empty()) << "nor where that is rejected again";
  EXPECT_EQ(taken(rejected, made_at(30, 30)), (std::vector<std::uint64_t>{1, 2}));
}

/// Of 30 x 10 cells, of which nothing was made but the ten at the left and the ten at the right.
WaitingMap with_a_gap() {
  WaitingMap stitched{.map = grid_update("ugv1", grid(0, 0, 30, 10)), .accepted = {}, .updates = {1, 2}};
  for (const double x : {0.0, 2.0})
    stitched.parts.push_back(
        {.map = grid_update("ugv1", grid(x, 0, 10, 10)), .accepted = {}, .updates = {1}});
  stitched.has_gaps = true;
  return stitched;
}

TEST(RejectedMessages, IsNotOvertakenByTheGapOfAStitchedGrid) {
  WaitingMap stitched = with_a_gap();
  RejectedMessages rejected;
  rejected.add(item(grid_update("ugv1", grid(1, 0, 10, 10))));  // in the middle
  rejected.add(item(grid_update("ugv1", grid(2, 0, 5, 5))));    // within the second part
  std::vector<std::uint64_t> replaced;
  for (const icd::MapUpdate* const map : said_by(stitched))
    std::ranges::copy(taken(rejected, *map), std::back_inserter(replaced));
  EXPECT_EQ(replaced, std::vector<std::uint64_t>{2});
  stitched.has_gaps = false;
  ASSERT_EQ(said_by(stitched).size(), 1u);
  EXPECT_EQ(taken(rejected, *said_by(stitched).front()), std::vector<std::uint64_t>{1});
}

TEST(RejectedMessages, IsSentAgainWhereWhatGoesHasAGapThere) {
  const auto back = [](double x, std::uint32_t cells) {
    return WaitingMap{
        .map = grid_update("ugv1", grid(x, 0, cells, cells)), .accepted = {}, .updates = {3}, .again = 10};
  };
  const WaitingMap goes = with_a_gap();
  EXPECT_FALSE(replaces(goes, back(1, 10))) << "in the middle";
  EXPECT_FALSE(replaces(goes, back(1.8, 5))) << "half in the second part";
  EXPECT_TRUE(replaces(goes, back(2, 5))) << "within it";
}

TEST(RejectedMessages, MarksADeleteAllThatWouldDeleteSomethingNewer) {
  RejectedMessages rejected;
  rejected.add(item(icd::MarkersUpdate{{marker("", 0, icd::MarkerAction::DeleteAll)}}));
  EXPECT_TRUE(taken(rejected, state_of({"ugv1"})).empty());
  EXPECT_EQ(taken(rejected, icd::MarkersUpdate{{marker("a", 1)}}), std::vector<std::uint64_t>{1});
}

TEST(RejectedMessages, HoldsOneForEachThatWouldSayTheSame) {
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
  EXPECT_EQ(rejected.items().front().number, 2 * RejectedMessages::kMostItems + 1) << "the oldest go";

  rejected.add(item(cloud_update("ugv1", {1}), RejectedMessages::kMostBytes + 1));
  EXPECT_EQ(rejected.items().size(), 1) << "one is always kept";
}

TEST(RejectedMessages, GivesAwayWhatIsTakenOnce) {
  RejectedMessages rejected;
  rejected.add(item(cloud_update("ugv1", {1})));
  EXPECT_TRUE(rejected.take(1));
  EXPECT_FALSE(rejected.take(1));
  EXPECT_EQ(rejected.find(1), nullptr);
}

TEST(StateLaneApart, FindsTheRobotThatIsAtFaultAndSendsTheOthers) {
  StateLane lane;
  lane.add(posted(state_of({"ugv1", "ugv2", "ugv3"})), at(0));
  lane.put_back_apart(*lane.take());
  std::vector<std::string> passed;
  for (int i = 0; i < 3; ++i) {
    const auto taken = lane.take(at(1 + i));
    ASSERT_EQ(taken->update.poses.size(), 1);
    const icd::RobotName& name = taken->update.poses.front().name;
    if (name.text() == "ugv2") {
      lane.give_up(name, at(1 + i));
    } else {
      lane.passed(*taken);
      passed.push_back(name.text());
    }
  }
  EXPECT_EQ(passed, (std::vector<std::string>{"ugv1", "ugv3"}));
  EXPECT_TRUE(lane.empty());

  lane.add(posted(state_of({"ugv1", "ugv2", "ugv3"})), at(5));
  const auto together = lane.take(at(6));
  ASSERT_EQ(together->update.poses.size(), 2) << "those that passed go together again";
  const auto apart = lane.take(at(20));
  ASSERT_EQ(apart->update.poses.size(), 1);
  EXPECT_EQ(apart->update.poses.front().name.text(), "ugv2");
  lane.passed(*apart);
  lane.add(posted(state_of({"ugv1"})), at(21));
  EXPECT_EQ(lane.take(at(22))->update.poses.size(), 3);
}

TEST(StateLaneApart, SendsAgainOnlyWhatWasGivenUpAndIsTheNewest) {
  const icd::StateUpdate set_aside = state_of({"ugv1"});
  StateLane lane;
  lane.add_unless_known(set_aside, at(0));
  const auto given_up = lane.take();
  ASSERT_TRUE(given_up) << "nothing newer is known";
  lane.add_unless_known(set_aside, at(1));
  EXPECT_TRUE(lane.empty()) << "it is under way";
  lane.give_up(set_aside.poses.front().name, at(1));
  lane.add_unless_known(set_aside, at(2));
  const auto again = lane.take();
  ASSERT_TRUE(again);
  lane.passed(*again);
  lane.add_unless_known(set_aside, at(3));
  EXPECT_TRUE(lane.empty()) << "it was taken";

  lane.add(posted(set_aside), at(4));
  lane.take();
  lane.add(posted(set_aside), at(5));  // a newer one
  lane.give_up(set_aside.poses.front().name, at(6));
  lane.passed(*lane.take());
  lane.add_unless_known(set_aside, at(7));
  EXPECT_TRUE(lane.empty()) << "a newer one was taken";
}

TEST(StateLaneApart, LetsARobotOnTrialRestWhileOthersHaveNews) {
  StateLane lane;
  lane.add(posted(state_of({"ugv1", "ugv2"})), at(0));
  lane.give_up(*robot("ugv2"), at(0));
  EXPECT_EQ(lane.take(at(1))->update.poses.front().name.text(), "ugv1");
  EXPECT_FALSE(lane.empty()) << "ugv2 has news still";
  EXPECT_EQ(lane.unsent().size(), 1) << "and ugv1 is under way";
}

TEST(MarkerLaneNarrower, FindsTheOneThatIsAtFault) {
  MarkerLane lane({.per_message = 64});
  icd::MarkersUpdate update;
  for (int id = 0; id < 64; ++id) update.markers.push_back(marker("a", id));
  lane.add(update, at(0));
  std::vector<std::int32_t> refused;
  std::size_t taken = 0;
  int messages = 0;
  while (auto waiting = lane.take()) {
    ++messages;
    const auto& markers = waiting->update.markers;
    const bool bad = std::ranges::find(markers, 37, &icd::Marker::id) != markers.end();
    if (!bad) {
      lane.passed();
      taken += markers.size();
    } else if (markers.size() > 1) {
      lane.put_back_narrower(*waiting);
    } else {
      refused.push_back(markers.front().id);
    }
  }
  EXPECT_EQ(refused, std::vector<std::int32_t>{37});
  EXPECT_EQ(taken, 63);
  EXPECT_LE(messages, 30);
}

TEST(MarkerLaneBehind, LetsOthersGoFirstAndLosesNothing) {
  MarkerLane lane({.per_message = 1});
  lane.add({{marker("a", 1)}}, at(0));
  lane.add({{marker("b", 1)}}, at(0));
  const auto first = lane.take();
  lane.put_behind(*first);
  EXPECT_EQ(lane.take()->update.markers.front().ns, "b");
  const auto again = lane.take();
  EXPECT_EQ(again->update.markers.front().ns, "a");
  EXPECT_EQ(again->updates, 1);
}

TEST(MarkerLaneBehind, GivesOutTheFirstOfAnUpdateWhenTheOthersHaveGone) {
  MarkerLane lane({.per_message = 1});
  lane.add({{marker("a", 1), marker("b", 1)}}, at(0));
  lane.put_behind(*lane.take());
  EXPECT_EQ(lane.take()->updates, 0u) << "its update has not gone whole";
  ASSERT_TRUE(lane.oldest());
  const auto again = lane.take();
  EXPECT_EQ(again->update.markers.front().ns, "a");
  EXPECT_EQ(again->updates, 1u);
}

TEST(MarkerLaneBehind, LeavesTheNewerChangeOfTheSameMarkerInItsPlace) {
  MarkerLane lane({.per_message = 1});
  lane.add({{marker("a", 1)}}, at(0));
  const auto first = lane.take();
  icd::Marker newer = marker("a", 1);
  newer.text = "newer";
  lane.add({{newer}}, at(1));
  lane.put_behind(*first);
  EXPECT_EQ(lane.count(), 1);
  const auto taken = lane.take();
  EXPECT_EQ(taken->update.markers.front().text, "newer");
  EXPECT_EQ(taken->updates, 2);
}

TEST(MarkerLaneBehind, NeverPutsADeleteAllBehindWhatFollowsIt) {
  MarkerLane lane({.per_message = 1});
  lane.add({{marker("", 0, icd::MarkerAction::DeleteAll), marker("a", 1)}}, at(0));
  for (int round = 0; round < 3; ++round) {
    const auto first = lane.take();
    ASSERT_EQ(first->update.markers.front().action, icd::MarkerAction::DeleteAll);
    lane.put_behind(*first);
    (void)lane.take();  // what goes ahead of it once
  }
  lane.passed();
  EXPECT_EQ(lane.take()->update.markers.front().action, icd::MarkerAction::DeleteAll);
  EXPECT_EQ(lane.take()->update.markers.front().ns, "a") << "in its own turn too";
}

TEST(MarkerLaneBehind, TriesWhetherOthersPassAheadOfADeleteAll) {
  MarkerLane lane({.per_message = 1});
  lane.add({{marker("", 0, icd::MarkerAction::DeleteAll), marker("a", 1), marker("b", 1)}}, at(0));
  std::vector<std::string> ahead;
  for (int round = 0; round < 3; ++round) {
    lane.put_behind(*lane.take());
    const auto other = lane.take();
    EXPECT_TRUE(other->is_ahead);
    EXPECT_EQ(other->updates, 0u) << "it waits still";
    ahead.push_back(other->update.markers.front().ns);
  }
  EXPECT_EQ(ahead, (std::vector<std::string>{"a", "b", "a"})) << "one of them may be at fault too";
  EXPECT_EQ(lane.count(), 3u);
}

TEST(MarkerLaneBehind, HasNothingToSendAheadOfADeleteAllThatIsAlone) {
  MarkerLane lane({.per_message = 1});
  lane.add({{marker("", 0, icd::MarkerAction::DeleteAll)}}, at(0));
  lane.put_behind(*lane.take());
  const auto again = lane.take();
  EXPECT_FALSE(again->is_ahead);
  EXPECT_EQ(again->updates, 1u);
}

/// It would go to another Command Post, hours later.
TEST(StateLane, MakesNoNewsOfWhatWasNoneWhenSendingFails) {
  StateLane lane;
  lane.add(posted(state_of({"ugv1"})), at(0));
  lane.passed(*lane.take());
  lane.add(posted(state_of({"ugv2"})), at(1));
  const auto both = *lane.take();
  ASSERT_EQ(both.update.poses.size(), 2u);
  lane.put_back(both);
  ASSERT_EQ(lane.unsent().size(), 1u);
  EXPECT_EQ(lane.unsent().front().name.text(), "ugv2");
}

TEST(StateLane, ForgetsRobotsWithoutNewsWhereItIsFull) {
  StateLane lane;
  icd::StateUpdate many;
  for (std::size_t i = 0; i < StateLane::kMostRobots; ++i) {
    many.poses.push_back({*robot("r" + std::to_string(i)), {}});
  }
  lane.add(posted(many), at(0));
  const auto under_way = *lane.take();
  EXPECT_FALSE(lane.has_room_for(state_of({"ugv1"}))) << "they may come back";
  lane.passed(under_way);
  lane.add(posted(state_of({"r7"})), at(1));
  ASSERT_TRUE(lane.has_room_for(state_of({"ugv1"})));
  lane.add(posted(state_of({"ugv1"})), at(2));
  EXPECT_EQ(lane.take()->update.poses.size(), 2u);
}

}  // namespace
}  // namespace adit::lanes
