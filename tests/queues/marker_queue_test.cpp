#include "queues/marker_queue.hpp"

#include <gmock/gmock.h>

#include <map>
#include <random>
#include <string>
#include <utility>

#include "queues/maps.hpp"
#include "queues/merged.hpp"

namespace adit::queues {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
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

/// The Command Post's display after a sequence of changes (ICD 6.6).
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
      if (action == icd::MarkerAction::Add && pick(2) == 0) add_geometry(changes.back());
    }
    return changes;
  }

 private:
  void add_geometry(icd::Marker& marker) {
    marker.type = static_cast<std::int32_t>(icd::MarkerType::LineStrip);
    for (int i = pick(30); i > 0; --i) marker.points.push_back({double(pick(9)), double(i), -1});
    if (pick(2) == 0) marker.colors.assign(marker.points.size(), {0, 0, double(pick(2)), 1});
    if (pick(4) == 0) marker.mesh_resource = "package://" + std::to_string(pick(9));
    marker.frame_locked = pick(2) == 0;
  }

  std::mt19937_64 random_;
  int text_ = 0;
};

TEST(MarkerChanges, NewerChangeReplacesTheOlder) {
  EXPECT_THAT(merged({add(1, "old"), add(2)}, {add(1, "new")}), ElementsAre(add(1, "new"), add(2)));
  EXPECT_THAT(merged({add(1), add(2)}, {remove(1)}), ElementsAre(remove(1), add(2)));
  EXPECT_THAT(merged({remove(1)}, {add(1)}), ElementsAre(add(1)));
}

TEST(MarkerChanges, NamespacesAreSeparate) {
  const auto a = marker(icd::MarkerAction::Add, "a", 1), b = marker(icd::MarkerAction::Add, "b", 1);
  EXPECT_THAT(merged({a}, {b}), ElementsAre(a, b));
}

TEST(MarkerChanges, DeleteAllReplacesAllBeforeIt) {
  EXPECT_THAT(merged({add(1), remove(2)}, {remove_all(), add(3)}), ElementsAre(remove_all(), add(3)));
}

TEST(MarkerChanges, DropsADeleteAfterADeleteAll) {
  EXPECT_THAT(merged({remove_all(), add(1)}, {remove(1), remove(2)}), ElementsAre(remove_all()));
}

TEST(MarkerChanges, MergingKeepsTheScene) {
  AnyChanges any{1};
  for (int i = 0; i < 1500; ++i) {
    const Scene scene = replay({}, any.changes());
    const auto older = any.changes(), newer = any.changes();
    const auto both = merged(older, newer);
    ASSERT_EQ(replay(scene, both), replay(replay(scene, older), newer));
    ASSERT_LE(both.size(), older.size() + newer.size());
    ASSERT_EQ(merged({}, both), both) << "merging again changes the message";
  }
}

std::vector<icd::Marker> in_order(const MarkerChanges& changes) {
  std::vector<icd::Marker> all;
  for (const auto& [place, marker] : changes.changes_by_place()) all.push_back(marker);
  return all;
}

TEST(MarkerChanges, LateOlderChangesGiveTheSameScene) {
  AnyChanges any{3};
  for (int i = 0; i < 1500; ++i) {
    const Scene scene = replay({}, any.changes());
    const auto older = any.changes(), newer = any.changes(), newest = any.changes();
    MarkerChanges late, changes;
    for (const icd::Marker& marker : older) late.apply(marker);
    for (const icd::Marker& marker : newer) changes.apply(marker);
    changes.apply_before(late);
    const auto both = in_order(changes);
    const Scene then = replay(replay(scene, older), newer);
    ASSERT_EQ(replay(scene, both), then);
    ASSERT_EQ(merged({}, both), both) << "merging again changes the message";
    ASSERT_EQ(changes.size().count, both.size());
    for (const icd::Marker& marker : newest) changes.apply(marker);
    ASSERT_EQ(replay(scene, in_order(changes)), replay(then, newest))
        << "replaying in order gives another scene";
  }
}

TEST(MarkerQueue, GivesNothingIfEmpty) {
  MarkerQueue queue{{.per_message = 10}};
  EXPECT_TRUE(queue.empty());
  EXPECT_FALSE(queue.pop(0));
  EXPECT_FALSE(queue.oldest());
}

TEST(MarkerQueue, SendsTheMarkersOfManyUpdatesTogether) {
  MarkerQueue queue{{.per_message = 10}};
  queue.add({{add(1), add(2)}}, at(1));
  queue.add({{add(2, "new"), add(3)}}, at(2));
  EXPECT_EQ(queue.count(), 3);
  EXPECT_EQ(queue.oldest(), at(1));
  const auto taken = queue.pop(0);
  EXPECT_THAT(taken->update.markers, ElementsAre(add(1), add(2, "new"), add(3)));
  EXPECT_EQ(taken->updates, 2);
  EXPECT_EQ(taken->accepted, at(1));
  EXPECT_TRUE(queue.empty());
}

TEST(MarkerQueue, CountsAnUpdateWithItsLastMarker) {
  MarkerQueue queue{{.per_message = 2}};
  queue.add({{add(1), add(2), add(3)}}, at(1));
  queue.add({{add(1, "new")}}, at(2));
  const auto first = queue.pop(0);
  EXPECT_THAT(first->update.markers, SizeIs(2));
  EXPECT_EQ(first->updates, 1) << "the second update's marker was first in the queue";
  EXPECT_EQ(queue.oldest(), at(1));
  EXPECT_EQ(queue.pop(0)->updates, 1);
}

TEST(MarkerQueue, SendsWhatRemainsOfALifetime) {
  MarkerQueue queue{{.per_message = 10}};
  std::vector markers{add(1), add(2), add(3), add(4, "for ever")};
  markers[0].lifetime = 10, markers[1].lifetime = 4.05, markers[2].lifetime = 3;
  markers[2].points.resize(2);
  start_lifetimes(markers, 100);
  queue.add({markers}, at(1));
  const auto first = *queue.pop(104);
  EXPECT_EQ(first.update.markers[0].lifetime, 6);
  EXPECT_EQ(first.update.markers[1].lifetime, MarkerQueue::kLeastLifetime);
  EXPECT_THAT(first.update.markers[2],
              AllOf(Field(&icd::Marker::id, 3), Field(&icd::Marker::points, IsEmpty()),
                    Field(&icd::Marker::action, icd::MarkerAction::Delete)));
  EXPECT_EQ(first.update.markers[3], add(4, "for ever"));
  queue.put_back(first);
  const auto retry = *queue.pop(106);
  EXPECT_EQ(retry.update.markers[0].lifetime, 4);
  EXPECT_EQ(retry.update.markers[1].action, icd::MarkerAction::Delete);
}

TEST(MarkerQueue, SendsAnUpdateWithoutMarkers) {
  MarkerQueue queue{{.per_message = 2}};
  queue.add({}, at(1));
  EXPECT_FALSE(queue.empty());
  const auto taken = queue.pop(0);
  EXPECT_THAT(taken->update.markers, IsEmpty());
  EXPECT_EQ(taken->updates, 1);
}

TEST(MarkerQueue, FailedMarkersGoBeforeLaterOnes) {
  MarkerQueue queue{{.per_message = 10}};
  queue.add({{add(1), add(2)}}, at(1));
  auto failed = *queue.pop(0);
  queue.add({{add(3), remove(2)}}, at(2));
  queue.put_back(failed);
  EXPECT_EQ(queue.oldest(), at(1));
  const auto taken = queue.pop(0);
  EXPECT_THAT(taken->update.markers, ElementsAre(add(1), remove(2), add(3)));
  EXPECT_EQ(taken->updates, 2);
}

TEST(MarkerQueue, LaterDeleteAllReplacesFailedMarkers) {
  MarkerQueue queue{{.per_message = 10}};
  queue.add({{add(1), add(2)}}, at(1));
  auto failed = *queue.pop(0);
  queue.add({{remove_all()}}, at(2));
  queue.put_back(failed);
  const auto taken = queue.pop(0);
  EXPECT_THAT(taken->update.markers, ElementsAre(remove_all()));
  EXPECT_EQ(taken->updates, 2);
}

TEST(MarkerQueue, FrequentChangesDoNotDelayOtherMarkers) {
  MarkerQueue queue{{.per_message = 1}};
  queue.add({{add(1), add(2)}}, at(1));
  queue.add({{add(1, "again")}}, at(2));
  queue.pop(0);
  queue.add({{add(1, "and again")}}, at(3));
  EXPECT_THAT(queue.pop(0)->update.markers, ElementsAre(add(2)));
}

icd::Marker path(std::int32_t id, std::size_t points) {
  icd::Marker path = add(id);
  path.points.resize(points);
  return path;
}

TEST(MarkerQueue, LimitsTheBytesOfAMessage) {
  MarkerQueue queue{{.bytes_per_message = icd::bytes_of(path(1, 10)) + icd::bytes_of(path(2, 20))}};
  queue.add({{path(1, 10), path(2, 20), path(3, 1), path(4, 90), path(5, 0)}}, at(1));
  EXPECT_THAT(queue.pop(0)->update.markers, ElementsAre(path(1, 10), path(2, 20)));
  EXPECT_THAT(queue.pop(0)->update.markers, ElementsAre(path(3, 1)));
  EXPECT_THAT(queue.pop(0)->update.markers, ElementsAre(path(4, 90))) << "a larger marker is sent alone";
  EXPECT_THAT(queue.pop(0)->update.markers, ElementsAre(path(5, 0)));
}

TEST(MarkerQueue, LimitsTheNumberOfMarkers) {
  MarkerQueue queue{{.per_message = 10, .bytes = std::size_t{1} << 30}};
  icd::MarkersUpdate many;
  for (std::size_t i = 0; i < MarkerQueue::kMostMarkers; ++i) {
    many.markers.push_back(add(static_cast<std::int32_t>(i)));
  }
  EXPECT_TRUE(queue.has_room_for(many));
  queue.add(many, at(1));
  EXPECT_FALSE(queue.has_room_for({{add(-1)}}));
  EXPECT_TRUE(queue.has_room_for({{add(7, "moved")}}));
  queue.pop(0);
  EXPECT_TRUE(queue.has_room_for({{add(-1)}}));
}

TEST(MarkerQueue, LimitsBytesButAcceptsReplacements) {
  const std::size_t quarter = icd::bytes_of(path(1, 1000));
  MarkerQueue queue{{.bytes = 4 * quarter}};
  queue.add({{path(1, 1000), path(2, 1000), path(3, 1000)}}, at(1));
  EXPECT_FALSE(queue.has_room_for({{path(4, 0)}}));
  EXPECT_FALSE(queue.has_room_for({{path(1, 1000), path(4, 10)}})) << "the update also adds a new marker";
  EXPECT_TRUE(queue.has_room_for({{path(1, 2000)}})) << "a path that grows";
  EXPECT_FALSE(queue.has_room_for({{path(1, 2100)}}));
  EXPECT_TRUE(queue.has_room_for({{path(1, 9000), path(1, 2000)}})) << "only the last change is queued";
  queue.add({{path(1, 2000)}}, at(2));
  EXPECT_TRUE(queue.has_room_for({{remove(1), path(2, 900)}}));
  EXPECT_TRUE(queue.has_room_for({{remove_all(), path(4, 1000)}}));
}

TEST(MarkerQueue, FullQueueStillAcceptsReplacementsInAnUpdate) {
  const std::size_t quarter = icd::bytes_of(path(1, 1000));
  MarkerQueue queue{{.bytes = 4 * quarter}};
  queue.add({{path(1, 1000), path(2, 1000), path(3, 1000)}}, at(1));
  const icd::MarkersUpdate update{{path(4, 10), path(1, 1010), remove(5), path(2, 1000)}};
  ASSERT_FALSE(queue.has_room_for(update));
  EXPECT_THAT(queue.queued_changes(update).markers, ElementsAre(path(1, 1010), path(2, 1000)));
  EXPECT_TRUE(queue.has_room_for(queue.queued_changes(update)));
  EXPECT_THAT(queue.queued_changes({{path(1, 1), remove_all(), path(7, 1)}}).markers,
              ElementsAre(remove_all()));
}

TEST(MarkerQueue, AcceptsAnyUpdateIfEmpty) {  // its sender could not be told when to retry
  const MarkerQueue queue{{.bytes = 1000}};
  EXPECT_TRUE(queue.has_room_for({{path(1, 5000)}}));
}

TEST(MarkerQueue, HasRoomForAMarkerThatChangesOften) {
  MarkerQueue queue{{}};
  constexpr int kTimes = 200'000;
  const icd::MarkersUpdate updates[] = {{{add(1)}}, {{remove_all()}}};
  for (int i = 0; i < kTimes; ++i) {
    const icd::MarkersUpdate& update = updates[i % 2];
    ASSERT_TRUE(queue.has_room_for(update));
    queue.add(update, at(i));
  }
  EXPECT_EQ(queue.pop(0)->updates, kTimes);
  EXPECT_TRUE(queue.empty());
}

TEST(MarkerChanges, TellTheirSizeAndTheirSizeWithAnUpdate) {
  AnyChanges any{2};
  for (int i = 0; i < 300; ++i) {
    MarkerChanges changes;
    for (int j = 0; j < 20; ++j) {
      const auto newer = any.changes();
      const auto foretold = changes.size_with(newer);
      for (const icd::Marker& marker : newer) changes.apply(marker);
      MarkerChanges::Size counted;
      for (const auto& [place, marker] : changes.changes_by_place()) {
        ++counted.count;
        counted.bytes += icd::bytes_of(marker);
      }
      ASSERT_EQ(changes.size(), counted);
      ASSERT_EQ(foretold, counted);
      if (any.pick(3) == 0) changes.pop({.count = 3, .bytes = 2000});
    }
  }
}

/// Drives a queue with random changes and failures. A display replays the sent messages.
class MarkerQueueLaws : public testing::TestWithParam<std::uint64_t> {};

TEST_P(MarkerQueueLaws, FinalSceneIsRightAndEachUpdateCountsOnce) {
  constexpr std::size_t kMost = 3, kMostBytes = 3000;
  AnyChanges any{GetParam()};
  MarkerQueue queue{{.per_message = kMost, .bytes_per_message = kMostBytes}};
  Scene wanted, shown;
  std::uint64_t accepted = 0, out = 0;
  const auto add_one = [&] {
    const icd::MarkersUpdate update{any.changes()};
    wanted = replay(wanted, update.markers);
    queue.add(update, at(static_cast<double>(accepted)));
    ++accepted;
  };
  const auto send_one = [&](bool fails) {
    auto taken = queue.pop(0);
    if (!taken) return;
    MarkerChanges sent;
    for (const icd::Marker& marker : taken->update.markers) sent.apply(marker);
    ASSERT_LE(sent.size().count, kMost);
    ASSERT_TRUE(sent.size().count <= 1 || sent.size().bytes <= kMostBytes);
    while (any.pick(3) == 0) add_one();
    if (fails) return queue.put_back(*taken);
    shown = replay(shown, taken->update.markers);
    out += taken->updates;
  };
  for (int i = 0; i < 300; ++i) {
    if (any.pick(3) == 0) add_one();
    send_one(any.pick(3) == 0);
  }
  while (!queue.empty()) {
    const auto before = queue.oldest();
    send_one(false);
    EXPECT_TRUE(queue.empty() || queue.oldest() >= before);
  }
  EXPECT_EQ(shown, wanted);
  EXPECT_EQ(queue.count(), 0);
  EXPECT_EQ(queue.bytes(), 0);
  EXPECT_EQ(out, accepted);
}

INSTANTIATE_TEST_SUITE_P(Courses, MarkerQueueLaws, testing::Range(std::uint64_t{1}, std::uint64_t{61}));

TEST(MarkerQueue, AppliesNewLimitsFromThenOn) {
  MarkerQueue queue({.per_message = 2});
  queue.add({{add(1), add(2), add(3), add(4), add(5)}}, at(1));
  queue.set_bounds({.per_message = 3});
  EXPECT_THAT(queue.pop(0)->update.markers, SizeIs(3));
  queue.set_bounds({.per_message = 1, .bytes = 1});
  EXPECT_THAT(queue.pop(0)->update.markers, SizeIs(1));
  EXPECT_FALSE(queue.has_room_for({{add(6)}}));
}

TEST(MarkerQueue, KeepsItsReducedMessageSize) {
  MarkerQueue queue({.per_message = 4});
  queue.add({{add(1), add(2), add(3), add(4)}}, at(1));
  queue.put_back_narrower(*queue.pop(0));
  queue.set_bounds({.per_message = 8});
  EXPECT_THAT(queue.pop(0)->update.markers, SizeIs(2));
}

}  // namespace
}  // namespace adit::queues
