#include <gtest/gtest.h>

#include "alarms/arrival.hpp"

namespace adit::alarms {
namespace {

TEST(RunClock, IsUnknownBeforeTheFirstStatus) {
  EXPECT_FALSE(RunClock().at(1000));
}

TEST(RunClock, RunsOnAfterOneStatusAndBecomesAnEstimate) {
  RunClock clock;
  clock.on_status(754, 1000);
  EXPECT_EQ(clock.at(1002), (ShownClock{.seconds = 756, .age = 2, .runs = true}));
  EXPECT_EQ(clock.at(1015), (ShownClock{.seconds = 769, .age = 15, .runs = true}));
  EXPECT_EQ(clock.at(1016), (ShownClock{.seconds = 770, .age = 16, .runs = true, .old = true}));
}

struct Row {
  const char* what;
  double first, second, apart;
  bool runs;
};
constexpr Row kRows[] = {
    {"it went on", 754, 756, 2, true},
    {"it stands", 754, 754, 2, false},
    {"of whole seconds, asked twice in one", 754, 754, 0.5, true},
    {"the run has not begun", 0, 0, 2, false},
    {"the run begins", 0, 1, 2, true},
    {"another run, which runs", 754, 12, 2, true},
    {"another run, which has not begun", 754, 0, 2, false},
};

TEST(RunClock, StopsIfTheLastStatusesAreEqual) {
  for (const Row& row : kRows) {
    RunClock clock;
    clock.on_status(row.first, 1000);
    clock.on_status(row.second, 1000 + row.apart);
    const auto shown = clock.at(1000 + row.apart + 20);
    ASSERT_TRUE(shown) << row.what;
    EXPECT_EQ(shown->runs, row.runs) << row.what;
    EXPECT_TRUE(shown->old) << row.what;
    EXPECT_EQ(shown->seconds, row.second + (row.runs ? 20 : 0)) << row.what;
  }
}

TEST(RunClock, ResumesWithTheFirstDifferentStatus) {
  RunClock clock;
  for (const double at : {1000.0, 1002.0, 1003.0}) clock.on_status(754, at);
  EXPECT_FALSE(clock.at(1003)->runs) << "two statuses in one second are no contradiction";
  clock.on_status(755, 1004);
  EXPECT_TRUE(clock.at(1004)->runs);
}

}  // namespace
}  // namespace adit::alarms
