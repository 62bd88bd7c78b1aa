// The order of senders with different habits.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "queues/map_queue.hpp"
#include "queues/maps.hpp"

namespace adit::queues {
namespace {

constexpr std::size_t kSlot = 1000;  // bytes

/// A patch that covers no other of the same sender.
icd::MapUpdate patch(const std::string& name, std::uint64_t number) {
  return grid_update(name, grid(10.0 * static_cast<double>(number), 0, 10, 10));
}

/// A queue, its maps so far, and the expected order of senders.
struct Race {
  MapQueue queue{0};  // merges no maps
  std::uint64_t number = 0;
  double now = 0;

  Race() { queue.set_slot_bytes(kSlot); }
  void post(icd::MapUpdate map) { queue.add(++number, std::move(map), at(now)); }
  /// Sends the next map, which takes `bytes` of the link. Returns its sender.
  std::string send(std::size_t bytes = 1) {
    const auto next = *queue.pop(at(now));
    queue.charge(Sender::from_map(next.map), bytes);
    return next.map.name->text();
  }
};

/// For each waiting sender: the senders that went before it since its wait began or it was last served, and
/// the senders that were waiting then.
class TurnCheck {
 public:
  void begin(const std::string& who) {
    if (!others_.contains(who)) others_[who] = waiting();
  }
  void served(const std::string& who, bool waits_still) {
    for (auto& [each, others] : others_) {
      if (each == who) continue;
      EXPECT_EQ(others.erase(who), 1)
          << who << " is served twice or before its turn, while " << each << " waits";
    }
    others_.erase(who);
    if (waits_still) begin(who);
  }

 private:
  std::set<std::string> waiting() const {
    std::set<std::string> all;
    for (const auto& [each, others] : others_) all.insert(each);
    return all;
  }
  std::map<std::string, std::set<std::string>> others_;
};

class MapTurns : public testing::TestWithParam<std::uint64_t> {};

TEST_P(MapTurns, WaitingSenderIsPassedAtMostOnceByEach) {
  std::mt19937_64 random{GetParam()};
  const auto pick = [&](int below) { return std::uniform_int_distribution{0, below - 1}(random); };
  Race race;
  TurnCheck turn_check;
  const int senders = 2 + pick(8);
  for (int slot = 0; slot < 120; ++slot) {
    race.now = slot;
    const auto post = [&](const std::string& who) {
      race.post(patch(who, race.number));
      turn_check.begin(who);
    };
    for (int i = 0; i < 6; ++i) post("hostile");
    if (pick(3) == 0) post("new" + std::to_string(slot));  // each time under another name
    for (int i = 0; i < senders; ++i) {
      if (pick(senders) == 0) post("R" + std::to_string(i));
    }
    const std::string who = race.send();
    turn_check.served(who, race.queue.count({robot(who), true}) > 0);
  }
}

TEST_P(MapTurns, NewestMapWaitsAtMostOneTurnPerSender) {
  std::mt19937_64 random{GetParam()};
  Race race;
  std::vector<std::string> names = {"hostile"};
  while (names.size() < 3 + GetParam() % 6) names.push_back("R" + std::to_string(names.size()));
  for (int slot = 0; slot < 100; ++slot) {
    race.now = slot;
    for (int i = 0; i < 6; ++i) race.post(patch("hostile", race.number));
    for (std::size_t i = 1; i < names.size(); ++i) {  // sometimes its whole map
      if (random() % i == 0) race.post(grid_update(names[i], grid(0, 0, 10, 10)));
    }
    const auto next = *race.queue.pop(at(race.now));
    if (next.map.name->text() == "hostile") continue;
    EXPECT_LT(at(race.now) - next.accepted, at(static_cast<double>(names.size())) - at(0));
  }
}

TEST_P(MapTurns, LargeMapsGetNoMoreOfTheLink) {
  constexpr std::size_t kLargest = 9;  // slots
  std::mt19937_64 random{GetParam()};
  Race race;
  const std::vector<std::string> names = {"hostile", "R1", "R2", "R3"};
  std::map<std::string, std::size_t> slots;
  std::size_t all = 0;
  while (all < 400) {
    for (const auto& name : names) race.post(patch(name, race.number));
    const auto next = *race.queue.pop();
    const std::size_t cost = next.map.name->text() == "hostile" ? 1 + random() % kLargest : 1 + random() % 2;
    race.queue.charge(Sender::from_map(next.map), cost * kSlot);
    slots[next.map.name->text()] += cost;
    all += cost;
    for (const auto& name : names) EXPECT_GE(slots[name] + kLargest, all / names.size()) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Races, MapTurns, testing::Range(std::uint64_t{1}, std::uint64_t{11}));

TEST(MapTurn, GridsAndCloudsOfARobotTakeSeparateTurns) {
  MapQueue queue{0};
  queue.add(1, patch("R1", 1), at(1));
  queue.add(2, patch("R1", 2), at(2));
  queue.add(3, cloud_update("R1", {1}), at(3));
  for (const std::uint64_t number : {1, 3, 2})
    EXPECT_THAT(queue.pop()->updates, testing::ElementsAre(number));
}

TEST(MapTurn, IsNotSavedUpByAnIdleSender) {
  Race race;
  for (int i = 0; i < 20; ++i) {
    race.post(patch("R1", race.number));
    race.send();
  }
  for (int i = 0; i < 3; ++i) race.post(patch("R2", race.number));
  for (int i = 0; i < 3; ++i) race.post(patch("R1", race.number));
  for (const char* name : {"R2", "R1", "R2", "R1", "R2", "R1"}) EXPECT_EQ(race.send(), name);
}

TEST(MapTurn, DebtOutlastsAnEmptyQueue) {
  Race race;
  race.post(patch("hostile", 1));
  for (int i = 0; i < 4; ++i) race.post(patch("R1", race.number));
  EXPECT_EQ(race.send(3 * kSlot), "hostile");
  race.post(patch("hostile", 2));
  for (const char* name : {"R1", "R1", "R1", "hostile", "R1"}) EXPECT_EQ(race.send(), name);
}

TEST(MapTurn, IsFreeIfNoOtherSenderWaits) {
  Race race;
  for (int i = 0; i < 3; ++i) race.post(patch("R1", race.number));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(race.send(9 * kSlot), "R1") << "no other sender waits";
}

TEST(MapTurn, ForgetsSendersThatAreGone) {
  Race race;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    race.post(patch("R" + std::to_string(i), i));
    race.send(i % 2 == 0 ? 1 : 5 * kSlot);
    EXPECT_LE(race.queue.senders(), 6);
  }
}

}  // namespace
}  // namespace adit::queues
