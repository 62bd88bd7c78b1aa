#include "queues/state_queue.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <string>

#include "queues/maps.hpp"

namespace adit::queues {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;
using testing::SizeIs;

icd::NamedPose pose(const std::string& name, double x) {
  return {*robot(name), {{x, 0, 0}, {}}};
}

std::vector<PostedPose> state(std::optional<icd::Stamp> stamp, std::vector<icd::NamedPose> poses,
                              const std::string& address = "10.0.0.5") {
  return posted({{stamp}, std::move(poses)}, address);
}

void post(StateQueue& queue, const std::vector<PostedPose>& poses, Instant now) {
  queue.add(queue.news_in(poses), now);
}

TEST(StateQueue, SendsAllRobotsInOneMessage) {
  StateQueue queue;
  post(queue, state(10, {pose("R2", 2)}), at(1));
  post(queue, state(11, {pose("R1", 1)}), at(2));
  const auto taken = queue.pop();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 1), pose("R2", 2)));
  EXPECT_THAT(taken->update.header.stamp, Optional(11.0));
  EXPECT_EQ(taken->accepted, at(1));
}

TEST(StateQueue, AlsoSendsRobotsWithoutNews) {
  StateQueue queue;
  post(queue, state(10, {pose("R1", 1), pose("R2", 2)}), at(1));
  queue.pop();
  post(queue, state(12, {pose("R2", 3)}), at(2));
  const auto taken = queue.pop();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 1), pose("R2", 3)));
  EXPECT_THAT(taken->news, ElementsAre(pose("R2", 3)));
}

TEST(StateQueue, GivesNothingWithoutNews) {
  StateQueue queue;
  EXPECT_FALSE(queue.pop());
  post(queue, state(10, {pose("R1", 1)}), at(1));
  EXPECT_FALSE(queue.empty());
  queue.pop();
  EXPECT_TRUE(queue.empty());
  EXPECT_FALSE(queue.pop());
}

struct OrderCase {
  const char* what;
  std::optional<icd::Stamp> held, newer;
  const char* address;  // of the newer pose
  double x;             // x of the pose that is kept: 1 is the earlier one, 2 the later one
};

class StateQueueOrder : public testing::TestWithParam<OrderCase> {};

TEST_P(StateQueueOrder, IsByStampWithinAClientElseByArrival) {
  const OrderCase& given = GetParam();
  StateQueue queue;
  post(queue, state(given.held, {pose("R1", 1)}), at(1));
  queue.on_passed(*queue.pop());
  post(queue, state(given.newer, {pose("R1", 2)}, given.address), at(2));
  EXPECT_EQ(queue.empty(), given.x == 1) << "an older pose is not news";
  post(queue, state(1, {pose("R2", 0)}), at(3));
  EXPECT_THAT(queue.pop()->update.poses, ElementsAre(pose("R1", given.x), pose("R2", 0)));
}

INSTANTIATE_TEST_SUITE_P(Table, StateQueueOrder,
                         testing::Values(OrderCase{"newer", 10, 11, "10.0.0.5", 2},
                                         OrderCase{"late", 10, 9, "10.0.0.5", 1},
                                         OrderCase{"the same", 10, 10, "10.0.0.5", 2},
                                         OrderCase{"of another client", 10, 9, "10.0.0.6", 2},
                                         OrderCase{"without a stamp", 10, {}, "10.0.0.5", 2},
                                         OrderCase{"after one without a stamp", {}, 9, "10.0.0.5", 2}),
                         [](const auto& test) {
                           std::string name = test.param.what;
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

TEST(StateQueue, RepeatsNoPoseOfAnEarlierRun) {
  StateQueue queue;
  post(queue, state(10, {pose("R1", 1), pose("R2", 1)}), at(1));
  queue.on_passed(*queue.pop());
  post(queue, state(11, {pose("R2", 2), pose("R3", 2)}), at(2));
  queue.begin_run();
  post(queue, state(12, {pose("R3", 3)}), at(3));
  const auto first = queue.pop();
  EXPECT_THAT(first->update.poses, ElementsAre(pose("R2", 2), pose("R3", 3))) << "a queued pose was lost";
  queue.on_passed(*first);
  post(queue, state(13, {pose("R4", 4)}), at(4));
  EXPECT_THAT(queue.pop()->update.poses, ElementsAre(pose("R3", 3), pose("R4", 4)));
  EXPECT_THAT(queue.news_in(state(9, {pose("R1", 9)})), IsEmpty()) << "a late pose is not news";
}

TEST(StateQueue, RetriesAPoseOfAnEarlierRunUntilDelivered) {
  StateQueue queue;
  post(queue, state(10, {pose("R1", 1)}), at(1));
  const auto under_way = *queue.pop();
  queue.begin_run();
  queue.put_back(under_way);
  const auto again = queue.pop();
  EXPECT_THAT(again->news, ElementsAre(pose("R1", 1)));
  post(queue, state(11, {pose("R1", 2)}), at(2));
  queue.on_passed(*again);
  queue.on_passed(*queue.pop());
  post(queue, state(12, {pose("R2", 3)}), at(3));
  EXPECT_THAT(queue.pop()->update.poses, ElementsAre(pose("R1", 2), pose("R2", 3))) << "R1 posted again";
}

TEST(StateQueue, FailedPosesAreNewsAndReplaceNoNewerOnes) {
  StateQueue queue;
  post(queue, state(10, {pose("R1", 1), pose("R2", 1)}), at(1));
  const auto failed = *queue.pop();
  post(queue, state(11, {pose("R1", 2)}), at(2));
  queue.put_back(failed);
  EXPECT_EQ(queue.next(at(2))->accepted, at(1));
  const auto taken = queue.pop();
  EXPECT_THAT(taken->update.poses, ElementsAre(pose("R1", 2), pose("R2", 1)));
  EXPECT_EQ(taken->accepted, at(1));
}

TEST(StateQueue, LimitsTheNumberOfRobots) {
  StateQueue queue;
  icd::StateUpdate many;
  for (std::size_t i = 0; i < StateQueue::kMostRobots; ++i) many.poses.push_back(pose(std::to_string(i), 0));
  EXPECT_TRUE(queue.has_room_for(many));
  queue.add(posted(many), at(1));
  EXPECT_FALSE(queue.has_room_for({{}, {pose("R1", 0)}}));
  EXPECT_TRUE(queue.has_room_for({{}, {pose("7", 0)}})) << "a known robot";
}

TEST(StateQueue, SendsTheNewestPosesUntilDelivered) {
  std::mt19937_64 random{1};
  const auto pick = [&](int below) { return std::uniform_int_distribution{0, below - 1}(random); };
  StateQueue queue;
  std::map<icd::RobotName, std::pair<icd::Stamp, double>> newest;
  std::map<icd::RobotName, double> lacking;  // missing at the Command Post
  int number = 0;
  const auto add = [&] {
    icd::StateUpdate update{{number + pick(5)}, {}};
    for (const char* name : {"R1", "R2", "R3"}) {
      if (pick(2) == 0) continue;
      update.poses.push_back(pose(name, number));
      auto& known = newest.try_emplace(*robot(name), -1, 0).first->second;
      if (*update.header.stamp < known.first) continue;
      known = {*update.header.stamp, number};
      lacking[*robot(name)] = number;
    }
    post(queue, posted(update), at(number));
    ++number;
  };
  for (int i = 0; i < 5000; ++i) {
    if (pick(2) == 0) add();
    ASSERT_EQ(queue.empty(), lacking.empty());
    auto taken = queue.pop();
    if (!taken) continue;
    ASSERT_THAT(taken->update.poses, SizeIs(newest.size()));
    for (const auto& robot : taken->update.poses) {
      ASSERT_EQ(robot.pose.position.x, newest.at(robot.name).second);
    }
    std::map<icd::RobotName, double> told;
    for (const auto& news : taken->news) told[news.name] = news.pose.position.x;
    ASSERT_EQ(told, lacking);
    if (pick(3) != 0) lacking.clear();
    const bool is_taken = lacking.empty();
    if (pick(3) == 0) add();
    is_taken ? queue.on_passed(*taken) : queue.put_back(*taken);
  }
}

/// Plays a Command Post that answers one state each second, while all robots post each second. Each robot
/// goes apart as in forward::States.
class OneRejectedRobot : public testing::Test {
 protected:
  void play(double until, const std::function<bool(const std::string&)>& rejects) {
    for (; now_ < until; now_ += 1) {
      for (const char* name : {"R1", "R2", "R3"}) post(queue_, state(now_, {pose(name, now_)}), at(now_));
      const auto sent = queue_.pop(at(now_));
      if (!sent) continue;
      const auto& poses = sent->update.poses;
      if (std::ranges::none_of(poses, [&](const auto& each) { return rejects(each.name.text()); })) {
        queue_.on_passed(*sent);
        for (const auto& each : poses) {
          blame_.on_passed(each.name.text(), at(now_));
          arrived_[each.name.text()] = each.pose.position.x;
        }
      } else if (Trial* const trial = queue_.trial_of(*sent)) {
        tries_.push_back(now_);
        blame_.on_failed(poses.front().name.text(), *trial, at(now_), false);
        queue_.put_back(*sent);
      } else {
        queue_.put_back_single(*sent);
      }
      for (const auto& [name, x] : arrived_) {
        if (!rejects(name)) oldest_ = std::max(oldest_, now_ - x);
      }
    }
  }

  StateQueue queue_;
  Blame blame_;
  double now_ = 0;
  std::map<std::string, double> arrived_;
  std::vector<double> tries_;  // of a robot alone that failed
  double oldest_ = 0;          // age of a pose of the others
};

TEST_F(OneRejectedRobot, RestsAndDelaysNoOther) {
  play(300, [](const std::string& name) { return name == "R2"; });
  EXPECT_LE(oldest_, 4);
  EXPECT_LE(tries_.size(), 12u) << "it rests up to a minute";
  oldest_ = 0;
  play(420, [](const std::string&) { return false; });
  EXPECT_EQ(arrived_["R2"], 419) << "it goes with the others after a pass";
}

TEST_F(OneRejectedRobot, GoesAtOnceToAnotherEndpoint) {
  play(300, [](const std::string& name) { return name == "R2"; });
  queue_.join_all();
  play(301, [](const std::string&) { return false; });
  EXPECT_EQ(arrived_["R2"], 300);
}

/// A wrong token, or a server that is down.
TEST_F(OneRejectedRobot, NoneRestsAfterAllWereRejected) {
  play(10, [](const std::string&) { return false; });
  play(200, [](const std::string&) { return true; });
  play(202, [](const std::string&) { return false; });
  for (const auto& [name, x] : arrived_) EXPECT_GE(x, 200) << name;
}

TEST_F(OneRejectedRobot, IsLateAlone) {
  play(300, [](const std::string& name) { return name == "R2"; });
  EXPECT_LE(*queue_.accepted_at(*robot("R2")), at(10));
  post(queue_, state(300, {pose("R1", 300)}), at(300));
  EXPECT_GE(*queue_.accepted_at(*robot("R1")), at(298));
}

/// The robot with the unregistered name may be silent, and the others may be.
TEST(StateQueue, TriesSilentRobotsAlone) {
  StateQueue queue;
  post(queue, state(1, {pose("R1", 1), pose("R2", 1)}), at(1));
  queue.on_passed(*queue.pop(at(1)));
  post(queue, state(2, {pose("R2", 2)}), at(2));
  queue.put_back_single(*queue.pop(at(2)));
  const auto first = *queue.pop(at(3));
  EXPECT_THAT(first.update.poses, ElementsAre(pose("R2", 2)));
  Blame().on_failed("R2", *queue.trial_of(first), at(3), false);
  queue.put_back(first);
  const auto second = *queue.pop(at(4));
  EXPECT_THAT(second.update.poses, ElementsAre(pose("R1", 1)));
  EXPECT_THAT(second.news, IsEmpty());
}

TEST(StateQueue, RepeatsNoPoseThatWasGivenUp) {
  StateQueue queue;
  post(queue, state(1, {pose("R1", 1), pose("R2", 1)}), at(1));
  queue.put_back_single(*queue.pop(at(1)));
  for (int i = 0; i < 2; ++i) {
    const auto alone = *queue.pop(at(2));
    if (alone.update.poses.front() == pose("R1", 1)) {
      queue.give_up(alone.update.poses.front().name, at(2));
    } else {
      queue.on_passed(alone);
    }
  }
  for (const double later : {20.0, 21.0, 22.0}) {
    post(queue, state(later, {pose("R2", later)}), at(later));
    const auto next = *queue.pop(at(later));
    EXPECT_THAT(next.update.poses, ElementsAre(pose("R2", later)));
    queue.on_passed(next);
  }
}

TEST(StateQueue, ForgetsDeliveredRobots) {
  StateQueue queue;
  post(queue, state(10, {pose("R1", 1), pose("R2", 2)}), at(1));
  queue.on_passed(*queue.pop());
  post(queue, state(12, {pose("R2", 3)}), at(2));
  queue.forget_accepted();
  EXPECT_TRUE(queue.pop());
  post(queue, state(13, {pose("R3", 4)}), at(3));
  EXPECT_THAT(queue.pop()->update.poses, ElementsAre(pose("R2", 3), pose("R3", 4)));
}

}  // namespace
}  // namespace adit::queues
