#include "loop/guard.hpp"

#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>

#include <new>
#include <stdexcept>
#include <string>
#include <variant>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::loop {
namespace {

/// What was told since the test began.
std::string told;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables): told by a plain function

class Guard : public testing::Test {
 protected:
  Guard() {
    told.clear();
    tell_of_caught(
        [](const char* where, const char* what) { told += std::string(where) + ": " + what + "\n"; });
  }
  ~Guard() override { tell_of_caught(nullptr); }

  std::uint64_t caught() const { return caught_so_far() - before_; }

 private:
  std::uint64_t before_ = caught_so_far();
};

TEST_F(Guard, EndsWhatThrowsAndNothingElseWhateverIsThrown) {
  EXPECT_TRUE(guarded("a test", [] {}));
  EXPECT_FALSE(guarded("a test", [] { throw std::bad_alloc(); }));
  EXPECT_FALSE(guarded("a test", [] { throw std::length_error("too long"); }));
  EXPECT_FALSE(guarded("a test", [] { (void)std::get<int>(std::variant<int, char>('x')); }));
  EXPECT_FALSE(guarded("a test", [] { throw 7; }));  // NOLINT(hicpp-exception-baseclass): libraries may
  EXPECT_EQ(caught(), 4);
  EXPECT_NE(told.find("a test: too long\n"), std::string::npos);
  EXPECT_NE(told.find("a test: unknown exception\n"), std::string::npos);
}

TEST_F(Guard, OutlivesALogThatThrowsItself) {
  tell_of_caught([](const char*, const char*) { throw std::bad_alloc(); });
  EXPECT_FALSE(guarded("a test", [] { throw std::runtime_error("x"); }));
  EXPECT_EQ(caught(), 1);
}

TEST_F(Guard, KeepsTheLoopTurningWhateverItsCallbacksThrow) {
  Loop loop;
  FileDescriptor events(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  const Source watched = loop.watch(events.get(), EPOLLIN, [&](std::uint32_t) {
    eventfd_t count = 0;
    ::eventfd_read(events.get(), &count);
    throw std::runtime_error("a socket's");
  });
  Source timer = loop.timer([] { throw std::runtime_error("a timer's"); });
  loop.post([] { throw std::runtime_error("a task's"); });
  Source last = loop.timer([&] { loop.stop(); });
  ::eventfd_write(events.get(), 1);
  timer.call_at(loop.now());
  last.call_at(loop.now() + std::chrono::milliseconds(20));
  loop.run();
  for (const char* const whose : {"a socket's", "a timer's", "a task's"}) {
    EXPECT_NE(told.find(whose), std::string::npos) << told;
  }
}

TEST_F(Guard, EndsTheJobThatThrowsAndTellsWhoeverWaitsForIt) {
  Loop loop;
  Workers workers(loop, 1);
  bool done = false, failed = false, next = false;
  workers.submit(
      Urgency::OnTheWay, [] { throw std::bad_alloc(); }, [&] { done = true; }, [&] { failed = true; });
  workers.submit(Urgency::OnTheWay, [] {}, [&] { next = true, loop.stop(); }, [] {});
  loop.run();
  EXPECT_FALSE(done);
  EXPECT_TRUE(failed);
  EXPECT_TRUE(next) << "the worker serves on";
  EXPECT_EQ(caught(), 1);
}

TEST_F(Guard, RunsTheOneEndOfAJobThatCopesWithEither) {
  Loop loop;
  Workers workers(loop, 1);
  workers.submit(Urgency::OnTheWay, [] { throw std::bad_alloc(); }, [&] { loop.stop(); });
  loop.run();
  EXPECT_EQ(caught(), 1);
}

}  // namespace
}  // namespace adit::loop
