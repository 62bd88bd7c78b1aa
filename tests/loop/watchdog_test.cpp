#include "loop/watchdog.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

namespace adit::loop {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kWithin{200}, kLongestJob{150};

class WatchdogTest : public testing::Test {
 protected:
  void turn(Duration length) {
    for (const Instant end = loop.now() + length; loop.now() < end;) loop.turn(milliseconds(5));
  }
  /// How often it is fed while the loop turns for that long.
  int fed_in(Duration length) {
    fed = 0;
    turn(length);
    return fed;
  }
  /// A job that ends when it is let go.
  std::shared_ptr<std::promise<void>> hang(Workers& workers) {
    auto let_go = std::make_shared<std::promise<void>>();
    workers.submit([waits = let_go->get_future().share()] { waits.wait(); }, [] {});
    return let_go;
  }

  Loop loop;
  int fed = 0;
  Watchdog watchdog{loop, kWithin, [this] { ++fed; }, kLongestJob};
};

TEST_F(WatchdogTest, IsFedFromTheStartAndFarMoreOftenThanItMust) {
  EXPECT_EQ(fed, 1);
  EXPECT_GE(fed_in(kWithin * 3), 6);
}

TEST_F(WatchdogTest, IsFedByNobodyButTheLoop) {
  fed = 0;
  std::this_thread::sleep_for(kWithin * 2);
  EXPECT_EQ(fed, 0);
}

TEST_F(WatchdogTest, IsFedWhileEveryWorkerAnswers) {
  Workers workers(loop, 3);
  watchdog.ask_also(&workers);
  EXPECT_GE(fed_in(kWithin * 3), 6);
  watchdog.ask_also(nullptr);
}

TEST_F(WatchdogTest, IsFedWhileWorkersNeverRest) {
  Workers workers(loop, 2);
  watchdog.ask_also(&workers);
  std::function<void()> again = [&] {
    workers.submit([] { std::this_thread::sleep_for(milliseconds(1)); }, [&again] { again(); });
  };
  for (int i = 0; i < 8; ++i) again();
  EXPECT_GE(fed_in(kWithin * 4), 8);
  watchdog.ask_also(nullptr);
}

TEST_F(WatchdogTest, IsFedDuringALongJobButStarvesWhenItDoesNotEnd) {
  Workers workers(loop, 2);
  watchdog.ask_also(&workers);
  turn(kWithin);
  const auto let_go = hang(workers);
  EXPECT_GE(fed_in(kLongestJob - milliseconds(50)), 1) << "a job may take that long";
  turn(kWithin);
  EXPECT_EQ(fed_in(kWithin * 3), 0) << "the other worker answers, this one does not";
  let_go->set_value();
  EXPECT_GE(fed_in(kWithin * 2), 3) << "it was only slow";
  watchdog.ask_also(nullptr);
}

TEST_F(WatchdogTest, AsksThoseThatTookOver) {
  Workers before(loop, 1);
  watchdog.ask_also(&before);
  const auto let_go = hang(before);
  turn(kLongestJob + kWithin);
  EXPECT_EQ(fed_in(kWithin), 0);
  Workers after(loop, 1);
  watchdog.ask_also(&after);
  EXPECT_GE(fed_in(kWithin * 2), 3);
  let_go->set_value();
  watchdog.ask_also(nullptr);
}

}  // namespace
}  // namespace adit::loop
