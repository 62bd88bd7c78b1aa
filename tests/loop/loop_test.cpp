#include "loop/loop.hpp"

#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "loop/turn_until.hpp"

namespace adit::loop {
namespace {

using std::chrono::milliseconds;

struct SocketPair {
  FileDescriptor ours, theirs;
  SocketPair() {
    int fds[2] = {-1, -1};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, fds), 0);
    ours = FileDescriptor(fds[0]);
    theirs = FileDescriptor(fds[1]);
  }
  void tell() const { EXPECT_EQ(::write(theirs.get(), "x", 1), 1); }
};

TEST(Loop, CallsAWatchWhenBytesCome) {
  Loop loop;
  const SocketPair pair;
  std::uint32_t events = 0;
  const Source source = loop.watch(pair.ours.get(), EPOLLIN, [&](std::uint32_t came) { events = came; });
  loop.turn(milliseconds(0));
  EXPECT_EQ(events, 0u);
  pair.tell();
  EXPECT_TRUE(turn_until(loop, [&] { return events == EPOLLIN; }));
}

TEST(Loop, WaitsForTheLastRequestedEvents) {
  Loop loop;
  const SocketPair pair;
  std::uint32_t events = 0;
  Source source = loop.watch(pair.ours.get(), EPOLLIN, [&](std::uint32_t came) { events = came; });
  source.wait_for(EPOLLOUT);
  EXPECT_TRUE(turn_until(loop, [&] { return events == EPOLLOUT; }));
}

TEST(Loop, ReportsNoHangUpWithoutRequestedEvents) {
  Loop loop;
  SocketPair pair;
  int calls = 0;
  Source source = loop.watch(pair.ours.get(), 0, [&](std::uint32_t) { ++calls; });
  pair.theirs = FileDescriptor();
  for (int i = 0; i < 5; ++i) loop.turn(milliseconds(1));
  EXPECT_EQ(calls, 0);
  source.wait_for(EPOLLIN);
  EXPECT_TRUE(turn_until(loop, [&] { return calls > 0; }));
}

TEST(Loop, LetsACallbackDestroyItsOwnSource) {
  Loop loop;
  const SocketPair pair;
  std::optional<Source> source;
  int calls = 0;
  source = loop.watch(pair.ours.get(), EPOLLIN, [&, kept = std::vector<int>(100, 7)](std::uint32_t) {
    source.reset();
    calls += kept.at(99);  // the running callback is still alive
  });
  pair.tell();
  for (int i = 0; i < 5; ++i) loop.turn(milliseconds(1));
  EXPECT_EQ(calls, 7);
}

TEST(Loop, LetsACallbackDestroyAnotherReadySource) {
  Loop loop;
  const SocketPair first, second;
  std::optional<Source> a, b;
  int calls = 0;
  a = loop.watch(first.ours.get(), EPOLLIN, [&](std::uint32_t) { ++calls, a.reset(), b.reset(); });
  b = loop.watch(second.ours.get(), EPOLLIN, [&](std::uint32_t) { ++calls, a.reset(), b.reset(); });
  first.tell();
  second.tell();
  for (int i = 0; i < 5; ++i) loop.turn(milliseconds(1));
  EXPECT_EQ(calls, 1);
}

TEST(Loop, LetsASourceOutliveIt) {
  std::optional<Source> source;
  const SocketPair pair;
  {
    Loop loop;
    source = loop.watch(pair.ours.get(), EPOLLIN, [](std::uint32_t) {});
  }
  source.reset();
}

TEST(Loop, AssigningASourceEndsTheOldWatch) {
  Loop loop;
  const SocketPair pair;
  int old_calls = 0, new_calls = 0;
  Source source = loop.watch(pair.ours.get(), EPOLLIN, [&](std::uint32_t) { ++old_calls; });
  source = Source();
  EXPECT_FALSE(source);
  source = loop.watch(pair.ours.get(), EPOLLIN, [&](std::uint32_t) { ++new_calls; });
  pair.tell();
  EXPECT_TRUE(turn_until(loop, [&] { return new_calls > 0; }));
  EXPECT_EQ(old_calls, 0);
}

TEST(Loop, FiresATimerOnceAndNeverEarly) {
  Loop loop;
  int calls = 0;
  const Instant when = loop.now() + milliseconds(20);
  Instant fired;
  Source timer = loop.timer([&] { ++calls, fired = loop.now(); });
  loop.turn(milliseconds(1));
  EXPECT_EQ(calls, 0) << "a timer that was not set fired";
  timer.call_at(when);
  EXPECT_TRUE(turn_until(loop, [&] { return calls > 0; }));
  EXPECT_GE(fired, when);
  loop.turn(milliseconds(5));
  EXPECT_EQ(calls, 1);
}

TEST(Loop, KeepsOnlyTheLastSettingOfATimer) {
  Loop loop;
  int calls = 0;
  Source timer = loop.timer([&] { ++calls; });
  timer.call_at(loop.now());
  timer.call_at(loop.now() + std::chrono::hours(1));
  loop.turn(milliseconds(10));
  EXPECT_EQ(calls, 0);
  timer.call_at(loop.now());
  timer.cancel();
  loop.turn(milliseconds(10));
  EXPECT_EQ(calls, 0);
  timer.call_at(Instant());  // the distant past
  EXPECT_TRUE(turn_until(loop, [&] { return calls == 1; }));
}

TEST(Loop, LetsATimerSetItselfAgain) {
  Loop loop;
  int calls = 0;
  Source timer;
  timer = loop.timer([&] {
    if (++calls < 3) timer.call_at(loop.now() + milliseconds(1));
  });
  timer.call_at(loop.now());
  EXPECT_TRUE(turn_until(loop, [&] { return calls == 3; }));
}

TEST(Loop, RunsPostedTasksInOrder) {
  Loop loop;
  std::vector<int> order;
  for (int i = 0; i < 5; ++i) loop.post([&order, i] { order.push_back(i); });
  EXPECT_TRUE(order.empty());
  loop.turn(milliseconds(0));
  EXPECT_EQ(order, (std::vector{0, 1, 2, 3, 4}));
}

TEST(Loop, ServesSocketsDuringEndlessTasks) {
  Loop loop;
  const SocketPair pair;
  bool read = false;
  const Source source = loop.watch(pair.ours.get(), EPOLLIN, [&](std::uint32_t) { read = true; });
  std::function<void()> again = [&] { loop.post(std::function(again)); };
  loop.post(std::function(again));
  pair.tell();
  for (int i = 0; i < 5; ++i) loop.turn(milliseconds(10));
  EXPECT_TRUE(read);
}

TEST(Loop, AcceptsTasksFromManyThreads) {
  Loop loop;
  constexpr int kThreads = 4, kTasks = 2000;
  int ran = 0;  // used only by the loop's thread
  const auto post_many = [&] {
    for (int i = 0; i < kTasks; ++i) {
      loop.post([&] {
        if (++ran == kThreads * kTasks) loop.stop();
      });
    }
  };
  std::vector<std::thread> threads(kThreads);
  for (auto& thread : threads) thread = std::thread(post_many);
  loop.run();
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(ran, kThreads * kTasks);
}

TEST(Loop, RunReturnsAtOnceIfStoppedBefore) {
  Loop loop;
  loop.stop();
  loop.run();
  bool ran = false;
  loop.post([&] { ran = true, loop.stop(); });
  loop.run();  // the loop can run again
  EXPECT_TRUE(ran);
}

TEST(Loop, CallsASignalHandler) {
  Loop loop;
  int calls = 0;
  const Source source = loop.signal(SIGUSR1, [&] { ++calls, loop.stop(); });
  ::kill(::getpid(), SIGUSR1);
  loop.run();
  EXPECT_EQ(calls, 1);
}

TEST(Loop, AdvancesTheStampByTheMonotonicClock) {
  const Loop loop;
  const double wall =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  const double first = loop.stamp_now();
  EXPECT_NEAR(first, wall, 10.0);
  std::this_thread::sleep_for(milliseconds(2));
  EXPECT_GE(loop.stamp_now() - first, 0.002);
}

TEST(Loop, ContinuesTheStampsOfAnEarlierProcess) {
  Loop loop;
  const double due = loop.stamp_now() + 1000;
  loop.set_stamp(due);
  EXPECT_GE(loop.stamp_now(), due);
  EXPECT_LT(loop.stamp_now(), due + 500);
}

}  // namespace
}  // namespace adit::loop
