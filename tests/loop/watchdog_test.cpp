#include "loop/watchdog.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "loop/turn_until.hpp"

namespace adit::loop {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kWithin{200}, kLongestJob{800};

class WatchdogTest : public testing::Test {
 protected:
  /// How often it is fed while the loop turns for that long.
  int fed_in(Duration length) {
    fed = 0;
    turn_for(loop, length);
    return fed;
  }
  bool turn_until_fed(int times) {
    fed = 0;
    return turn_until(loop, [&] { return fed >= times; });
  }
  /// Whether it is fed three times in each `within` and more; on a busy machine, after some time.
  bool is_fed_often() {
    for (int attempt = 0; attempt < 20; ++attempt) {
      const Instant began = loop.now();
      if (turn_until_fed(6) && loop.now() - began < 2 * kWithin) return true;
    }
    return false;
  }
  /// A job that has begun, and ends when it is let go.
  std::shared_ptr<std::promise<void>> hang(Workers& workers) {
    auto let_go = std::make_shared<std::promise<void>>();
    std::promise<void> begun;
    workers.submit(
        Urgency::OnTheWay,
        [&begun, waits = let_go->get_future().share()] { begun.set_value(), waits.wait(); }, [] {});
    begun.get_future().wait();
    return let_go;
  }

  Loop loop;
  int fed = 0;
  Watchdog watchdog{loop, kWithin, [this] { ++fed; }, kLongestJob};
};

TEST_F(WatchdogTest, IsFedFromTheStartAndFarMoreOftenThanItMust) {
  EXPECT_EQ(fed, 1);
  EXPECT_TRUE(is_fed_often());
}

TEST_F(WatchdogTest, IsFedByNobodyButTheLoop) {
  fed = 0;
  std::this_thread::sleep_for(kWithin * 2);
  EXPECT_EQ(fed, 0);
}

TEST_F(WatchdogTest, IsFedWhileEveryWorkerAnswers) {
  Workers workers(loop, 3);
  watchdog.ask_also({&workers});
  EXPECT_TRUE(is_fed_often());
  watchdog.ask_also({});
}

TEST_F(WatchdogTest, IsFedWhileWorkersNeverRest) {
  Workers workers(loop, 2);
  watchdog.ask_also({&workers});
  std::function<void()> again = [&] {
    workers.submit(
        Urgency::OnTheWay, [] { std::this_thread::sleep_for(milliseconds(1)); }, [&again] { again(); });
  };
  for (int i = 0; i < 8; ++i) again();
  EXPECT_TRUE(is_fed_often());
  watchdog.ask_also({});
}

TEST_F(WatchdogTest, IsFedDuringALongJobButStarvesWhenItDoesNotEnd) {
  Workers workers(loop, 2);
  watchdog.ask_also({&workers});
  turn_for(loop, kWithin);
  const auto let_go = hang(workers);
  EXPECT_TRUE(turn_until_fed(2)) << "a job may take a while";
  turn_for(loop, kLongestJob);
  EXPECT_EQ(fed_in(kWithin * 3), 0) << "the other worker answers, this one does not";
  let_go->set_value();
  EXPECT_TRUE(is_fed_often()) << "it was only slow";
  watchdog.ask_also({});
}

TEST_F(WatchdogTest, StarvesWhereAWriterHangsThoughTheWorkersAnswer) {
  Workers workers(loop, 2);
  Writer writer(loop);
  watchdog.ask_also({&workers, &writer});
  EXPECT_TRUE(is_fed_often());
  const auto let_go = hang(writer);
  turn_for(loop, kLongestJob);
  EXPECT_EQ(fed_in(kWithin * 3), 0);
  let_go->set_value();
  EXPECT_TRUE(is_fed_often());
  watchdog.ask_also({});
}

TEST_F(WatchdogTest, AsksThoseThatTookOver) {
  Workers before(loop, 1);
  watchdog.ask_also({&before});
  const auto let_go = hang(before);
  EXPECT_TRUE(turn_until_fed(1));
  turn_for(loop, kLongestJob);
  EXPECT_EQ(fed_in(kWithin), 0);
  Workers after(loop, 1);
  watchdog.ask_also({&after});
  EXPECT_TRUE(is_fed_often());
  let_go->set_value();
  watchdog.ask_also({});
}

}  // namespace
}  // namespace adit::loop
