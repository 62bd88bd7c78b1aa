#include "lanes/marker_lane.hpp"

#include <gmock/gmock.h>

#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "lanes/maps.hpp"

namespace adit::lanes {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

icd::Marker marker(icd::MarkerAction action, const std::string& ns, std::int32_t id, std::string text = "") {
  icd::Marker marker;
  marker.action = action;
  marker.ns = ns;
  marker.id = id;
  marker.text = std::move(text);
  return marker;
}

icd::Marker add(std::int32_t id, std::string text = "") {
  return marker(icd::MarkerAction::Add, "", id, std::move(text));
}
icd::Marker remove(std::int32_t id) {
  return marker(icd::MarkerAction::Delete, "", id);
}
icd::Marker remove_all() {
  return marker(icd::MarkerAction::DeleteAll, "", 0);
}

/// What the Command Post's display shows after a row of changes (ICD 6.6).
using Scene = std::map<std::pair<std::string, std::int32_t>, icd::Marker>;

Scene replay(Scene scene, const std::vector<icd::Marker>& changes) {
  for (const auto& change : changes) {
    if (change.action == icd::MarkerAction::DeleteAll) scene.clear();
    if (change.action == icd::MarkerAction::Delete) scene.erase({change.ns, change.id});
    if (change.action == icd::MarkerAction::Add) scene[{change.ns, change.id}] = change;
  }
  return scene;
}

class AnyChanges {
 public:
  explicit AnyChanges(std::uint64_t seed) : random_{seed} {}

  int pick(int below) { return std::uniform_int_distribution{0, below - 1}(random_); }

  std::vector<icd::Marker> changes() {
    std::vector<icd::Marker> changes;
    for (int i = pick(6); i > 0; --i) {
      const int what = pick(20);
      const auto action = what == 0  ? icd::MarkerAction::DeleteAll
                          : what < 6 ? icd::MarkerAction::Delete
                                     : icd::MarkerAction::Add;
      changes.push_back(marker(action, pick(2) == 0 ? "a" : "b", pick(4), std::to_string(++text_)));
    }
    return changes;
  }

 private:
  std::mt19937_64 random_;
  int text_ = 0;
};

TEST(MergeMarkers, TheNewerChangeTakesThePlaceOfTheOlder) {
  EXPECT_THAT(merge({add(1, "old"), add(2)}, {add(1, "new")}), ElementsAre(add(1, "new"), add(2)));
  EXPECT_THAT(merge({add(1), add(2)}, {remove(1)}), ElementsAre(remove(1), add(2)));
  EXPECT_THAT(merge({remove(1)}, {add(1)}), ElementsAre(add(1)));
}

TEST(MergeMarkers, TellsNamespacesApart) {
  const auto a = marker(icd::MarkerAction::Add, "a", 1), b = marker(icd::MarkerAction::Add, "b", 1);
  EXPECT_THAT(merge({a}, {b}), ElementsAre(a, b));
}

TEST(MergeMarkers, DeleteAllTakesThePlaceOfAllBeforeIt) {
  EXPECT_THAT(merge({add(1), remove(2)}, {remove_all(), add(3)}), ElementsAre(remove_all(), add(3)));
}

TEST(MergeMarkers, DeletesNothingThatADeleteAllHasDeleted) {
  EXPECT_THAT(merge({remove_all(), add(1)}, {remove(1), remove(2)}), ElementsAre(remove_all()));
}

TEST(MergeMarkers, ReplayingTheMergedChangesGivesTheSameSceneAsReplayingBoth) {
  AnyChanges any{1};
  for (int i = 0; i < 20'000; ++i) {
    const Scene scene = replay({}, any.changes());
    const auto older = any.changes(), newer = any.changes();
    const auto merged = merge(older, newer);
    ASSERT_EQ(replay(scene, merged), replay(replay(scene, older), newer));
    ASSERT_LE(merged.size(), older.size() + newer.size());
    ASSERT_EQ(merge({}, merged), merged) << "as few as say the same";
  }
}

TEST(MarkerLane, GivesOutNothingWhereNothingWaits) {
  MarkerLane lane{10};
  EXPECT_TRUE(lane.empty());
  EXPECT_FALSE(lane.take());
  EXPECT_FALSE(lane.oldest());
}

TEST(MarkerLane, SendsTheMarkersOfManyUpdatesTogether) {
  MarkerLane lane{10};
  lane.add(1, {{add(1), add(2)}}, at(1));
  lane.add(2, {{add(2, "new"), add(3)}}, at(2));
  EXPECT_EQ(lane.count(), 3);
  EXPECT_EQ(lane.oldest(), at(1));
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.markers, ElementsAre(add(1), add(2, "new"), add(3)));
  EXPECT_THAT(taken->updates, ElementsAre(1, 2));
  EXPECT_EQ(taken->accepted, at(1));
  EXPECT_TRUE(lane.empty());
}

TEST(MarkerLane, AnUpdatesNumberGoesWithTheLastOfItsMarkers) {
  MarkerLane lane{2};
  lane.add(1, {{add(1), add(2), add(3)}}, at(1));
  lane.add(2, {{add(1, "new")}}, at(2));
  const auto first = lane.take();
  EXPECT_THAT(first->update.markers, SizeIs(2));
  EXPECT_THAT(first->updates, ElementsAre(2)) << "its one marker stood first in line";
  EXPECT_EQ(lane.oldest(), at(1));
  EXPECT_THAT(lane.take()->updates, ElementsAre(1));
}

TEST(MarkerLane, AnUpdateWithoutMarkersComesOutToo) {
  MarkerLane lane{2};
  lane.add(1, {}, at(1));
  EXPECT_FALSE(lane.empty());
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.markers, IsEmpty());
  EXPECT_THAT(taken->updates, ElementsAre(1));
}

TEST(MarkerLane, WhatIsPutBackGoesBeforeWhatCameMeanwhile) {
  MarkerLane lane{10};
  lane.add(1, {{add(1), add(2)}}, at(1));
  auto failed = *lane.take();
  lane.add(2, {{add(3), remove(2)}}, at(2));
  lane.put_back(failed);
  EXPECT_EQ(lane.oldest(), at(1));
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.markers, ElementsAre(add(1), remove(2), add(3)));
  EXPECT_THAT(taken->updates, ElementsAre(1, 2));
}

TEST(MarkerLane, ADeleteAllThatCameMeanwhileStandsForWhatIsPutBack) {
  MarkerLane lane{10};
  lane.add(1, {{add(1), add(2)}}, at(1));
  auto failed = *lane.take();
  lane.add(2, {{remove_all()}}, at(2));
  lane.put_back(failed);
  const auto taken = lane.take();
  EXPECT_THAT(taken->update.markers, ElementsAre(remove_all()));
  EXPECT_THAT(taken->updates, ElementsAre(1, 2));
}

TEST(MarkerLane, AMarkerThatChangesAllTheTimeHoldsUpNoOther) {
  MarkerLane lane{1};
  lane.add(1, {{add(1), add(2)}}, at(1));
  lane.add(2, {{add(1, "again")}}, at(2));
  lane.take();
  lane.add(3, {{add(1, "and again")}}, at(3));
  EXPECT_THAT(lane.take()->update.markers, ElementsAre(add(2)));
}

TEST(MarkerLane, HasAnEndToWhatItHolds) {
  MarkerLane lane{10};
  icd::MarkersUpdate many;
  for (std::size_t i = 0; i < MarkerLane::kMostMarkers; ++i) {
    many.markers.push_back(add(static_cast<std::int32_t>(i)));
  }
  EXPECT_TRUE(lane.has_room_for(many));
  lane.add(1, many, at(1));
  EXPECT_FALSE(lane.has_room_for({{add(-1)}}));
  lane.take();
  EXPECT_TRUE(lane.has_room_for({{add(-1)}}));
}

/// Drives a lane with random changes and failures against a display that replays what it is sent.
class MarkerLaneLaws : public testing::TestWithParam<std::uint64_t> {};

TEST_P(MarkerLaneLaws, TheDisplayEndsAsIfEveryUpdateHadBeenReplayedAndEveryNumberComesOutOnce) {
  constexpr std::size_t kMost = 3;
  AnyChanges any{GetParam()};
  MarkerLane lane{kMost};
  Scene wanted, shown;
  std::uint64_t accepted = 0;
  std::multiset<std::uint64_t> out;
  const auto add_one = [&] {
    const icd::MarkersUpdate update{any.changes()};
    wanted = replay(wanted, update.markers);
    lane.add(accepted, update, at(static_cast<double>(accepted)));
    ++accepted;
  };
  const auto send_one = [&](bool fails) {
    auto taken = lane.take();
    if (!taken) return;
    ASSERT_LE(taken->update.markers.size(), kMost);
    while (any.pick(3) == 0) add_one();
    if (fails) return lane.put_back(*taken);
    shown = replay(shown, taken->update.markers);
    out.insert(taken->updates.begin(), taken->updates.end());
  };
  for (int i = 0; i < 300; ++i) {
    if (any.pick(3) == 0) add_one();
    send_one(any.pick(3) == 0);
  }
  while (!lane.empty()) {
    const auto before = lane.oldest();
    send_one(false);
    EXPECT_TRUE(lane.empty() || lane.oldest() >= before);
  }
  EXPECT_EQ(shown, wanted);
  EXPECT_EQ(lane.count(), 0);
  ASSERT_EQ(out.size(), accepted);
  for (std::uint64_t number = 0; number < accepted; ++number) EXPECT_EQ(out.count(number), 1) << number;
}

INSTANTIATE_TEST_SUITE_P(Courses, MarkerLaneLaws, testing::Range(std::uint64_t{1}, std::uint64_t{61}));

}  // namespace
}  // namespace adit::lanes
