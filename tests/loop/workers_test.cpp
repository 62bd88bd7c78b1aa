#include "loop/workers.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <future>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

#include "loop/turn_until.hpp"

namespace adit::loop {
namespace {

TEST(Workers, RunJobsOffTheLoopAndFinishOnIt) {
  Loop loop;
  Workers workers(loop, 2);
  const auto here = std::this_thread::get_id();
  std::thread::id worked, finished;
  workers.submit(
      Urgency::OnTheWay, [&] { worked = std::this_thread::get_id(); },
      [&] { finished = std::this_thread::get_id(), loop.stop(); });
  loop.run();
  EXPECT_NE(worked, here);
  EXPECT_EQ(finished, here);
}

TEST(Workers, BeginJobsInTheOrderOfSubmission) {
  Loop loop;
  Workers workers(loop, 1);
  std::vector<int> begun, finished;
  for (int i = 0; i < 100; ++i) {
    workers.submit(
        Urgency::OnTheWay, [&begun, i] { begun.push_back(i); },
        [&, i] {
          finished.push_back(i);
          if (i == 99) loop.stop();
        });
  }
  loop.run();
  std::vector<int> expected(100);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(begun, expected);
  EXPECT_EQ(finished, expected);
}

/// Occupies the only worker until it is released.
class Held {
 public:
  Held(Workers& workers, Urgency urgency) {
    std::promise<void> begun;
    workers.submit(
        urgency, [&begun, until = let_go_.get_future().share()] { begun.set_value(), until.wait(); }, [] {});
    begun.get_future().wait();
  }
  void let_go() { let_go_.set_value(); }

 private:
  std::promise<void> let_go_;
};

TEST(Workers, RunUrgentJobsFirst) {
  Loop loop;
  Workers workers(loop, 1);
  Held held(workers, Urgency::OnTheWay);
  int maps = 3, pictures = 3;
  const Instant came = loop.now();
  for (int i = 0; i < 3; ++i) {
    const auto draw = [&] { EXPECT_TRUE(maps == 0 || loop.now() - came >= JobQueue<int>::kPatience); };
    workers.submit(Urgency::CanWait, draw, [&] { --pictures; });
  }
  for (int i = 0; i < 3; ++i) workers.submit(Urgency::OnTheWay, [&] { --maps; }, [] {});
  held.let_go();
  EXPECT_TRUE(turn_until(loop, [&] { return pictures == 0; }));
}

TEST(Workers, RunPatientJobsUnderLoad) {
  Loop loop;
  Workers workers(loop, 1);
  bool drawn = false;
  std::function<void()> again = [&] {
    workers.submit(
        Urgency::OnTheWay, [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); },
        [&] { again(); });
  };
  for (int i = 0; i < 100; ++i) again();
  workers.submit(Urgency::CanWait, [] {}, [&] { drawn = true; });
  EXPECT_TRUE(turn_until(loop, [&] { return drawn; }));
}

TEST(Workers, RunUrgentJobsInsideAYieldingJob) {
  Loop loop;
  Workers workers(loop, 1);
  bool map_done = false, drawn = false, amid = false;
  std::promise<void> begun;
  workers.submit(
      Urgency::CanWait,
      [&] {
        begun.set_value();
        while (!map_done) workers.give_way();
        amid = true;
      },
      [&] { drawn = true; });
  begun.get_future().wait();
  workers.submit(Urgency::OnTheWay, [&] { map_done = true; }, [&] { EXPECT_FALSE(drawn); });
  ASSERT_TRUE(turn_until(loop, [&] { return drawn; }));
  EXPECT_TRUE(amid);
}

TEST(Workers, PassDataWithoutLocks) {
  Loop loop;
  Workers workers(loop, 3);
  int left = 500;
  long sum = 0;
  for (int i = 0; i < 500; ++i) {
    auto data = std::make_shared<std::vector<long>>(100, i);
    workers.submit(
        Urgency::OnTheWay, [data] { data->assign(1, std::accumulate(data->begin(), data->end(), 0L)); },
        [&, data] {
          EXPECT_EQ(data.use_count(), 1) << "the worker still holds the returned data";
          sum += data->at(0);
          if (--left == 0) loop.stop();
        });
  }
  loop.run();
  EXPECT_EQ(sum, 100L * 499 * 500 / 2);
}

TEST(Workers, LetACompletionSubmitTheNextJob) {
  Loop loop;
  Workers workers(loop, 1);
  int rounds = 0;
  std::function<void()> next = [&] {
    if (++rounds == 50) return loop.stop();
    workers.submit(Urgency::OnTheWay, [] {}, next);
  };
  next();
  loop.run();
  EXPECT_EQ(rounds, 50);
}

TEST(Workers, DestructorWaitsForTheRunningJobOnly) {
  Loop loop;
  std::atomic<bool> second_ran = true;  // on a busy machine it may run before they are destroyed
  for (int attempt = 0; attempt < 20 && second_ran; ++attempt) {
    std::promise<void> begun;
    std::atomic<bool> completed = false;
    bool finished = false;
    second_ran = false;
    {
      Workers workers(loop, 1);
      workers.submit(
          Urgency::OnTheWay,
          [&] {
            begun.set_value();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            completed = true;
          },
          [&] { finished = true; });
      workers.submit(Urgency::OnTheWay, [&] { second_ran = true; }, [&] { finished = true; });
      begun.get_future().wait();
    }
    EXPECT_TRUE(completed);
    for (int i = 0; i < 3; ++i) loop.turn(std::chrono::milliseconds(1));
    EXPECT_FALSE(finished) << "a `done` ran after the workers were destroyed";
  }
  EXPECT_FALSE(second_ran);
}

TEST(Writer, CompletesAllJobsInOrderBeforeItEnds) {
  Loop loop;
  std::vector<int> written;
  bool finished = false;
  {
    Writer writer(loop);
    for (int i = 0; i < 50; ++i) {
      writer.submit(
          [&written, i] {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            written.push_back(i);
          },
          [&] { finished = true; });
    }
  }
  std::vector<int> expected(50);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(written, expected);
  for (int i = 0; i < 3; ++i) loop.turn(std::chrono::milliseconds(1));
  EXPECT_FALSE(finished) << "a `done` ran after the writer was destroyed";
}

TEST(Workers, AreAtLeastOne) {
  Loop loop;
  Workers workers(loop, 0);
  workers.submit(Urgency::OnTheWay, [] {}, [&] { loop.stop(); });
  loop.run();
}

template <class Threads>
int nice_of(Threads&& threads_for) {
  Loop loop;
  auto threads = threads_for(loop);
  int nice = -1;
  threads->submit(
      Urgency::OnTheWay, [&] { nice = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); },
      [&] { loop.stop(); });
  loop.run();
  return nice;
}

TEST(Workers, RunAtLowerPriorityThanLoopAndWriter) {
  const int of_loop = getpriority(PRIO_PROCESS, 0);
  EXPECT_EQ(nice_of([](Loop& loop) { return std::make_unique<Workers>(loop, 1); }), std::max(of_loop, 10));
  EXPECT_EQ(nice_of([](Loop& loop) -> std::unique_ptr<Workers> { return std::make_unique<Writer>(loop); }),
            of_loop);
}

TEST(Workers, LeaveSignalsToTheLoop) {
  Loop loop;
  Workers workers(loop, 1);
  bool blocked = false;
  workers.submit(
      Urgency::OnTheWay,
      [&] {
        sigset_t set;
        pthread_sigmask(SIG_SETMASK, nullptr, &set);
        blocked = sigismember(&set, SIGTERM) == 1 && sigismember(&set, SIGUSR2) == 1;
      },
      [&] { loop.stop(); });
  loop.run();
  EXPECT_TRUE(blocked);
}

}  // namespace
}  // namespace adit::loop
