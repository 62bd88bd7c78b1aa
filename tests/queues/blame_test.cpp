// Which message causes a 500: Blame and the queues with several kinds of servers, in simulated time.
#include "queues/blame.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "queues/map_queue.hpp"
#include "queues/maps.hpp"

namespace adit::queues {
namespace {

/// Whether a server accepts a map with that value in its points, at that second.
using Server = std::function<bool(std::uint8_t, double)>;

struct Outcome {
  std::vector<std::uint8_t> delivered, rejected;
  std::size_t waiting = 0;
  int tries_of_first = 0;
};

/// `senders` robots post a cloud each second, numbered 1, 2, 3 and so on. The first posts 1, the second 2,
/// and so on. One cloud is sent each second, in the gateway's order.
Outcome played(const Server& server, int clouds, int senders, double until) {
  MapQueue queue(0);  // no clouds are merged
  Blame blame;
  Outcome outcome;
  int posted = 0;
  for (double now = 0; now < until; now += 1) {
    for (int i = 0; i < 1 && posted < clouds; ++i, ++posted) {
      const std::string name = "ugv" + std::to_string(posted % senders);
      queue.add(static_cast<std::uint64_t>(posted) + 1,
                cloud_update(name, {static_cast<std::uint8_t>(posted + 1)}), at(now));
    }
    auto map = queue.pop(at(now));
    if (!map) continue;
    const std::uint8_t which = points_of(map->map).front();
    const std::string name = map->map.name->text();
    outcome.tries_of_first += which == 1 ? 1 : 0;
    if (server(which, now)) {
      blame.on_passed(name, at(now));
      outcome.delivered.push_back(which);
    } else if (blame.on_failed(name, map->trial, at(now)) == Blame::Decision::Reject) {
      outcome.rejected.push_back(which);
    } else {
      queue.put_back(std::move(*map));
    }
  }
  outcome.waiting = queue.count();
  return outcome;
}

TEST(Blame, RejectsNothingDuringAnOutage) {
  for (const double length : {3.0, 30.0, 600.0}) {
    const Server outage = [&](std::uint8_t, double now) { return now < 5 || now >= 5 + length; };
    const Outcome outcome = played(outage, 20, 3, 5 + length + 30);
    EXPECT_TRUE(outcome.rejected.empty()) << length;
    EXPECT_EQ(outcome.delivered.size(), 20) << length;
    EXPECT_EQ(outcome.waiting, 0) << length;
  }
}

TEST(Blame, RejectsTheOnlyFailingMapAndDeliversTheRest) {
  for (const int senders : {1, 2, 5}) {
    const Outcome outcome = played([](std::uint8_t which, double) { return which != 1; }, 30, senders, 60);
    EXPECT_EQ(outcome.rejected, std::vector<std::uint8_t>{1}) << senders;
    EXPECT_EQ(outcome.delivered.size(), 29) << senders;
    EXPECT_GE(outcome.tries_of_first, 4) << senders << ": tries of the first map are too few";
    EXPECT_LE(outcome.tries_of_first, 6) << senders << ": the first map delays others";
  }
}

TEST(Blame, RejectsSeveralFailingMapsWhileOthersPass) {
  const auto is_good = [](std::uint8_t which, double) { return which % 5 != 0 || which > 30; };
  const Outcome outcome = played(is_good, 100, 5, 300);
  EXPECT_EQ(outcome.rejected.size(), 6) << "all first maps of one robot fail";
  EXPECT_EQ(outcome.delivered.size(), 94);
}

TEST(Blame, KeepsFailingMapsQueuedIfNoOtherIsSent) {
  const Outcome outcome = played([](std::uint8_t which, double) { return which % 5 != 0; }, 30, 5, 200);
  EXPECT_GE(outcome.rejected.size(), 1);
  EXPECT_EQ(outcome.rejected.size() + outcome.waiting, 6)
      << "the last maps stay queued until another is accepted";
  EXPECT_EQ(outcome.delivered.size(), 24);
}

TEST(Blame, SpacesTheTries) {
  Blame blame;
  Trial trial;
  std::vector<double> rests;
  double now = 0;
  while (blame.on_failed("ugv1", trial, at(now)) == Blame::Decision::Retry) {
    blame.on_passed("ugv2", at(now + 0.5));
    const double rest = std::chrono::duration<double>(trial.rests_until - at(now)).count();
    rests.push_back(rest);
    now += std::max(rest, 1.0);
  }
  EXPECT_EQ(rests, (std::vector<double>{0, 2, 4}));
}

/// Such as 403: the sender, the token or the server may be the reason.
TEST(Blame, RestsUpToAMinuteIfTheAnswerMayNotReject) {
  Blame blame;
  Trial trial;
  std::vector<double> rests;
  double now = 0;
  for (int i = 0; i < 9; ++i) {
    ASSERT_EQ(blame.on_failed("ugv1", trial, at(now), false), Blame::Decision::Retry) << i;
    blame.on_passed("ugv2", at(now + 0.5));
    rests.push_back(std::chrono::duration<double>(trial.rests_until - at(now)).count());
    now += std::max(rests.back(), 1.0);
  }
  EXPECT_EQ(rests, (std::vector<double>{0, 2, 4, 8, 16, 32, 60, 60, 60}));
  EXPECT_EQ(blame.on_failed("ugv1", trial, at(now)), Blame::Decision::Retry)
      << "its first answer that may reject it";
}

TEST(Blame, CountsNoStrikeBeforeAnotherMapPassed) {
  Blame blame;
  Trial trial;
  blame.on_passed("ugv2", at(0));
  for (int i = 1; i < 100; ++i) {
    ASSERT_EQ(blame.on_failed("ugv1", trial, at(i)), Blame::Decision::Retry);
  }
  EXPECT_EQ(trial.strikes, 0);
}

TEST(Blame, CountsNoStrikeIfAnotherSenderAlsoFails) {
  Blame blame;
  Trial trial, other;
  blame.on_passed("ugv2", at(0));
  blame.on_failed("ugv1", trial, at(1));
  blame.on_passed("ugv3", at(2));
  blame.on_failed("ugv2", other, at(3));  // it was accepted before
  blame.on_failed("ugv1", trial, at(4));
  EXPECT_EQ(trial.strikes, 0);
  blame.on_passed("ugv3", at(5));
  blame.on_failed("ugv2", other, at(6));  // on trial itself, so its failure says little about others
  blame.on_failed("ugv1", trial, at(7));
  EXPECT_EQ(trial.strikes, 1);
}

TEST(Blame, RejectsFewMapsIfHalfOfAllTriesFailAtRandom) {
  std::size_t rejected = 0, delivered = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random{seed};
    const Outcome outcome = played([&](std::uint8_t, double) { return random() % 2 == 0; }, 60, 4, 400);
    rejected += outcome.rejected.size();
    delivered += outcome.delivered.size();
    EXPECT_EQ(outcome.waiting, 0);
  }
  EXPECT_LE(rejected, delivered / 50);
}

TEST(MapQueueOnTrial, SendsOneOtherMapFirst) {
  MapQueue queue(0);
  queue.add(1, cloud_update("ugv1", {1}), at(0));
  queue.add(2, cloud_update("ugv2", {2}), at(1));
  queue.add(3, cloud_update("ugv2", {3}), at(2));
  Blame blame;
  auto first = queue.pop(at(3));
  ASSERT_EQ(points_of(first->map).front(), 1);
  blame.on_failed("ugv1", first->trial, at(3));
  queue.put_back(std::move(*first));
  EXPECT_EQ(points_of(queue.pop(at(4))->map).front(), 2);
  EXPECT_EQ(points_of(queue.pop(at(5))->map).front(), 1) << "only one other map goes first";
}

TEST(MapQueueOnTrial, KeepsLaterGridsOfItsNameBehindItAtFirst) {
  MapQueue queue(0);
  queue.add(1, grid_update("ugv1", grid(0, 0, 10, 10)), at(0));
  queue.add(2, grid_update("ugv1", grid(0.25, 0.25, 10, 10)),
            at(1));  // overlaps it without forming a rectangle
  Blame blame;
  for (int i = 0; i < SenderQueue::kInPlace; ++i) {
    auto taken = queue.pop(at(10 * i));
    ASSERT_EQ(taken->updates.front(), 1) << i;
    blame.on_failed("ugv1", taken->trial, at(10 * i));
    queue.put_back(std::move(*taken));
  }
  EXPECT_EQ(queue.pop(at(100))->updates.front(), 2) << "to see whether others pass";
}

TEST(MapQueueOnTrial, DoesNotMergeAFailedMap) {
  MapQueue queue(1000);
  queue.add(1, cloud_update("ugv1", {1}), at(0));
  Blame blame;
  auto first = queue.pop(at(1));
  blame.on_failed("ugv1", first->trial, at(1));
  queue.put_back(std::move(*first));
  queue.add(2, cloud_update("ugv1", {2}), at(2));
  queue.add(3, cloud_update("ugv1", {3}), at(2));
  EXPECT_EQ(points_of(queue.pop(at(3))->map), (std::vector<std::uint8_t>{2, 3}));
  EXPECT_EQ(points_of(queue.pop(at(4))->map), (std::vector<std::uint8_t>{1}));
}

/// One robot posts maps that are too large each three seconds, another one good maps each second. One map is
/// sent each second.
TEST(MapQueueOnTrial, TriesALaterMapTwiceAfterOneThatWasTooLarge) {
  MapQueue queue(0);
  Blame blame;
  std::map<std::uint64_t, int> tries;  // by the number of the map
  int delivered = 0;
  for (std::uint64_t now = 0; now < 60; ++now) {
    if (now % 3 == 0) queue.add(1000 + now, cloud_update("large", {1}), at(static_cast<double>(now)));
    queue.add(now, cloud_update("good", {2}), at(static_cast<double>(now)));
    const Instant instant = at(static_cast<double>(now));
    auto map = *queue.pop(instant);
    const std::string name = map.map.name->text();
    if (name == "good") {
      blame.on_passed(name, instant);
      queue.on_passed(Sender::from_map(map.map));
      ++delivered;
      continue;
    }
    ++tries[map.updates.back()];
    const auto next = blame.on_failed(name, map.trial, instant);
    queue.on_too_large(Sender::from_map(map.map), map.trial);
    if (next == Blame::Decision::Retry) queue.put_back(std::move(map));
  }
  ASSERT_GE(tries.size(), 4);
  EXPECT_EQ(tries.begin()->second, 4);
  for (auto each = std::next(tries.begin()); each != std::prev(tries.end()); ++each)
    EXPECT_EQ(each->second, 2) << each->first;
  EXPECT_GE(delivered, 47) << "large maps that rest cost nobody a turn";
}

TEST(MapQueueOnTrial, ForgetsStrikesOnceAMapOfThatRobotPassed) {
  MapQueue queue(0);
  Blame blame;
  queue.add(1, cloud_update("ugv1", {1}), at(0));
  auto first = *queue.pop(at(0));
  for (int i = 0; blame.on_failed("ugv1", first.trial, at(i)) == Blame::Decision::Retry; ++i)
    blame.on_passed("ugv2", at(i + 0.5));
  queue.on_too_large(Sender::from_map(first.map), first.trial);
  queue.add(2, cloud_update("ugv1", {2}), at(3));
  queue.on_passed(Sender::from_map(first.map));
  queue.add(3, cloud_update("ugv1", {3}), at(3));
  for (const std::uint64_t number : {2u, 3u}) {
    const auto later = queue.pop(at(3));
    EXPECT_THAT(later->updates, testing::ElementsAre(number));
    EXPECT_EQ(later->trial.strikes, 0);
  }
}

TEST(MapQueueOnTrial, GivesItsPlaceToANewerCoveringGrid) {
  MapQueue queue(0);
  queue.add(1, grid_update("ugv1", grid(0, 0, 10, 10)), at(0));
  auto first = queue.pop(at(1));
  first->trial.failures = 4;
  first->trial.strikes = Blame::kMostStrikes - 1;
  first->trial.failed = at(1);
  queue.put_back(std::move(*first));
  queue.add(2, grid_update("ugv1", grid(0, 0, 20, 20)), at(2));
  const auto newer = queue.pop(at(3));
  EXPECT_EQ(newer->updates, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_LE(newer->trial.strikes, Blame::kMostStrikes - 2) << "the newer map starts without most strikes";
}

}  // namespace
}  // namespace adit::queues
