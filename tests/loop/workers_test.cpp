#include "loop/workers.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <csignal>
#include <future>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

namespace adit::loop {
namespace {

TEST(Workers, WorkOffTheLoopAndFinishOnIt) {
  Loop loop;
  Workers workers(loop, 2);
  const auto here = std::this_thread::get_id();
  std::thread::id worked, finished;
  workers.submit([&] { worked = std::this_thread::get_id(); },
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
    workers.submit([&begun, i] { begun.push_back(i); },
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

TEST(Workers, HandDataThereAndBackWithoutLocks) {
  Loop loop;
  Workers workers(loop, 3);
  int left = 500;
  long sum = 0;
  for (int i = 0; i < 500; ++i) {
    auto data = std::make_shared<std::vector<long>>(100, i);
    workers.submit([data] { data->assign(1, std::accumulate(data->begin(), data->end(), 0L)); },
                   [&, data] {
                     EXPECT_EQ(data.use_count(), 1) << "the worker still holds what it has handed back";
                     sum += data->at(0);
                     if (--left == 0) loop.stop();
                   });
  }
  loop.run();
  EXPECT_EQ(sum, 100L * 499 * 500 / 2);
}

TEST(Workers, LetADoneSubmitTheNextJob) {
  Loop loop;
  Workers workers(loop, 1);
  int rounds = 0;
  std::function<void()> next = [&] {
    if (++rounds == 50) return loop.stop();
    workers.submit([] {}, next);
  };
  next();
  loop.run();
  EXPECT_EQ(rounds, 50);
}

TEST(Workers, WaitForARunningJobAndDropTheRestWhenDestroyed) {
  Loop loop;
  std::atomic<bool> second_ran = true;  // on a busy machine it may, before they are destroyed
  for (int attempt = 0; attempt < 20 && second_ran; ++attempt) {
    std::promise<void> begun;
    std::atomic<bool> completed = false;
    bool finished = false;
    second_ran = false;
    {
      Workers workers(loop, 1);
      workers.submit(
          [&] {
            begun.set_value();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            completed = true;
          },
          [&] { finished = true; });
      workers.submit([&] { second_ran = true; }, [&] { finished = true; });
      begun.get_future().wait();
    }
    EXPECT_TRUE(completed);
    for (int i = 0; i < 3; ++i) loop.turn(std::chrono::milliseconds(1));
    EXPECT_FALSE(finished) << "a `done` ran after the workers were destroyed";
  }
  EXPECT_FALSE(second_ran);
}

TEST(Writer, DoesAllThatWasSubmittedInOrderBeforeItEnds) {
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
  workers.submit([] {}, [&] { loop.stop(); });
  loop.run();
}

TEST(Workers, LeaveSignalsToTheLoop) {
  Loop loop;
  Workers workers(loop, 1);
  bool blocked = false;
  workers.submit(
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
