#include "queues/step_back.hpp"

#include <gmock/gmock.h>

#include <map>
#include <random>
#include <string>
#include <vector>

#include "queues/maps.hpp"
#include "queues/stamps.hpp"
#include "queues/state_queue.hpp"

namespace adit::queues {
namespace {

struct Said {
  icd::Stamp stamp;
  Connection connection;
};

struct StepBackCase {
  const char* what;
  std::vector<Said> said;
  int shown;  // index of the message that shows it; -1: no message
};

class StepBackCases : public testing::TestWithParam<StepBackCase> {};

TEST_P(StepBackCases, AreDetected) {
  StepBack step_back;
  const StepBackCase& given = GetParam();
  for (std::size_t i = 0; i < given.said.size(); ++i) {
    EXPECT_EQ(step_back.shown_by(given.said[i].stamp, given.said[i].connection),
              static_cast<int>(i) == given.shown)
        << given.what << ", message " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, StepBackCases,
    testing::Values(
        StepBackCase{"a clock that runs", {{10, 1}, {10.1, 1}, {13, 1}}, -1},
        StepBackCase{"one connection keeps the order", {{10, 1}, {10.1, 1}, {8.2, 1}, {8.3, 1}}, 2},
        StepBackCase{"by too little to matter", {{10, 1}, {9.1, 1}, {9.2, 1}, {10.1, 1}}, -1},
        StepBackCase{
            "overtaken on the other of two", {{7, 2}, {7.1, 1}, {10, 1}, {7.2, 2}, {10.1, 1}, {10.2, 2}}, -1},
        StepBackCase{
            "overtaken again and again", {{10, 1}, {7, 2}, {10.1, 1}, {7.2, 2}, {10.2, 1}, {7.4, 2}}, -1},
        StepBackCase{"a connection that had said something later", {{9.9, 2}, {10, 1}, {7, 2}, {7.1, 1}}, 2},
        StepBackCase{"a new connection for each message", {{9.9, 1}, {10, 2}, {7, 3}, {7.1, 4}, {7.2, 5}}, 3},
        StepBackCase{
            "of which one was overtaken", {{9.9, 1}, {10.1, 2}, {8, 3}, {10.2, 4}, {8.1, 5}, {10.3, 6}}, -1},
        StepBackCase{
            "the same again on a new connection proves nothing", {{10, 1}, {7, 2}, {7, 3}, {10.1, 4}}, -1},
        StepBackCase{"one that was silent for long", {{6, 2}, {10, 1}, {7, 2}, {7.1, 2}}, 3},
        StepBackCase{"connections that are not known", {{10, 0}, {7, 0}, {7.1, 0}}, -1}));

/// A robot's clock runs. The robot posts on several connections. Each connection waits for an answer before
/// its next message and may delay it for any time.
TEST(StepBack, IsNotSeenInMessagesReorderedByConnections) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> held_up{0, 4.5};
  std::bernoulli_distribution often{0.3}, reopens{0.2};
  for (int robot = 0; robot < 200; ++robot) {
    StepBack step_back;
    std::multimap<double, Said> arrivals;  // by arrival time
    Connection last_opened = 2;
    for (auto [connection, now] : {std::pair<Connection, double>{1, 0}, {2, 0.05}}) {
      for (Connection on = connection; now < 60;) {
        const double arrives = now + (often(random) ? held_up(random) : 0.01);
        arrivals.emplace(arrives, Said{100 + now, on});
        now = arrives + 0.1;
        if (reopens(random)) on = ++last_opened + 100 * connection;
      }
    }
    for (const auto& [at, said] : arrivals) {
      ASSERT_FALSE(step_back.shown_by(said.stamp, said.connection)) << "robot " << robot << " at " << at;
    }
  }
}

/// The rule from end to end: a robot's clock is set back sometimes, and its newest pose is forwarded after
/// at most one further message.
TEST(StepBack, IsDetectedWithinOneMessage) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> by{2.0, 4.9};
  for (const int connections : {1, 2, 0}) {  // 0: a new connection for each message
    SCOPED_TRACE(connections);
    StampShift shift;
    StateQueue queue;
    double offset = 0, clock_was_set = -1, sent = -1;
    for (int number = 0; number < 3000; ++number) {
      const double now = 1'650'000'000 + number * 0.1;
      if (number % 100 == 99) offset -= by(random), clock_was_set = number;
      const Connection on = connections == 0 ? number + 1 : number % connections + 1;
      const auto stamp =
          shift.shift({.address = "10.0.0.5", .robot = "R1"}, now - 1e9 + offset, now, {.connection = on});
      const icd::Pose pose{{static_cast<double>(number), 0, 0}, {}};
      queue.add(queue.news_in(posted({{stamp}, {{*robot("R1"), pose}}})), at(number));
      if (const auto taken = queue.take()) sent = taken->update.poses.front().pose.position.x;
      ASSERT_GE(sent, number == clock_was_set ? number - 1 : number) << "the pose sent after this message";
    }
  }
}

}  // namespace
}  // namespace adit::queues
