#include "loop/watchdog.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "loop/simulated_time.hpp"
#include "loop/turn_until.hpp"

namespace adit::loop {
namespace {

using namespace std::chrono_literals;

constexpr Duration kWithin = 8min, kRound = kWithin / 4;

class WatchdogTest : public testing::Test {
 protected:
  /// How often the watchdog is fed in `rounds`.
  int fed_in(int rounds) {
    const int before = fed;
    for (int i = 0; i < rounds; ++i) {
      time.pass(kRound);
      time.pass(loop, 1ms);
    }
    return fed - before;
  }
  /// Whether it is fed in each of `rounds`, if `workers` get enough time to answer.
  bool is_fed(int rounds, const std::vector<Workers*>& workers) {
    for (int i = 0; i < rounds; ++i) {
      for (const Workers* each : workers) {
        if (!turn_until(loop, [each] { return each->are_responsive(Watchdog::kLongestJob); })) return false;
      }
      if (fed_in(1) != 1) return false;
    }
    return true;
  }
  /// Starts a job that ends when the promise is set.
  std::shared_ptr<std::promise<void>> hang(Workers& workers) {
    auto let_go = std::make_shared<std::promise<void>>();
    std::promise<void> begun;
    workers.submit(
        Urgency::OnTheWay,
        [&begun, waits = let_go->get_future().share()] { begun.set_value(), waits.wait(); }, [] {});
    begun.get_future().wait();
    return let_go;
  }

  static constexpr int kLongestJob = Watchdog::kLongestJob / kRound;  // rounds
  SimulatedTime time;
  Loop loop;
  int fed = 0;
  Watchdog watchdog{loop, kWithin, [this] { ++fed; }};
};

TEST_F(WatchdogTest, IsFedFromTheStartAndOften) {
  EXPECT_EQ(fed, 1);
  EXPECT_EQ(fed_in(8), 8);
}

TEST_F(WatchdogTest, IsFedOnlyByTheLoop) {
  time.pass(kWithin * 2);
  EXPECT_EQ(fed, 1);
}

TEST_F(WatchdogTest, IsFedWhileEveryWorkerAnswers) {
  Workers workers(loop, 3);
  watchdog.watch_workers({&workers});
  EXPECT_TRUE(is_fed(8, {&workers}));
  watchdog.watch_workers({});
}

TEST_F(WatchdogTest, IsFedWhileWorkersAreBusy) {
  Workers workers(loop, 2);
  watchdog.watch_workers({&workers});
  int done = 0;
  std::function<void()> again = [&] {
    workers.submit(Urgency::OnTheWay, [] { std::this_thread::sleep_for(1ms); }, [&] { ++done, again(); });
  };
  for (int i = 0; i < 8; ++i) again();
  for (int round = 0; round < kLongestJob + 2; ++round) {
    ASSERT_TRUE(turn_until(loop, [&, before = done] { return done >= before + 8; }));
    EXPECT_EQ(fed_in(1), 1) << round;
  }
  watchdog.watch_workers({});
}

TEST_F(WatchdogTest, IsFedDuringALongButNotAnEndlessJob) {
  Workers workers(loop, 2);
  watchdog.watch_workers({&workers});
  const auto let_go = hang(workers);
  EXPECT_TRUE(is_fed(kLongestJob - 1, {&workers})) << "a job may take a while";
  EXPECT_EQ(fed_in(4), 0) << "only the other worker answers";
  let_go->set_value();
  EXPECT_TRUE(is_fed(4, {&workers})) << "the worker was only slow";
  watchdog.watch_workers({});
}

TEST_F(WatchdogTest, StarvesIfAWriterHangs) {
  Workers workers(loop, 2);
  Writer writer(loop);
  watchdog.watch_workers({&workers, &writer});
  const auto let_go = hang(writer);
  EXPECT_TRUE(is_fed(kLongestJob - 1, {&workers, &writer}));
  EXPECT_EQ(fed_in(4), 0);
  let_go->set_value();
  EXPECT_TRUE(is_fed(4, {&workers, &writer}));
  watchdog.watch_workers({});
}

TEST_F(WatchdogTest, AsksReplacedWorkers) {
  Workers before(loop, 1);
  watchdog.watch_workers({&before});
  const auto let_go = hang(before);
  fed_in(kLongestJob + 1);
  EXPECT_EQ(fed_in(1), 0);
  Workers after(loop, 1);
  watchdog.watch_workers({&after});
  EXPECT_TRUE(is_fed(4, {&after}));
  let_go->set_value();
  watchdog.watch_workers({});
}

TEST_F(WatchdogTest, TellsOfAJobThatTakesTooLong) {
  Workers workers(loop, 1);
  int overran = 0;
  JobWatch watch(loop, [&overran] { ++overran; });
  const auto starts = watch.begin();
  fed_in(kLongestJob * 3);
  EXPECT_EQ(overran, 0) << "it has not started";
  starts();
  fed_in(kLongestJob - 1);
  EXPECT_EQ(overran, 0);
  fed_in(kLongestJob * 2);
  EXPECT_EQ(overran, 1);
  watch.begin()();
  watch.end();
  fed_in(kLongestJob * 2);
  EXPECT_EQ(overran, 1) << "the second one ended";
}

TEST(Watchdog, IsFedInRealTime) {
  Loop loop;
  int fed = 0;
  const Watchdog watchdog(loop, 40ms, [&fed] { ++fed; });
  EXPECT_TRUE(turn_until(loop, [&fed] { return fed == 4; }));
}

}  // namespace
}  // namespace adit::loop
