#include "loop/guard.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::loop {
namespace {

/// The messages since the test began.
std::string told;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables): told by a plain function

class Guard : public testing::Test {
 protected:
  Guard() {
    told.clear();
    set_exception_logger(
        [](const char* where, const char* what) { told += std::string(where) + ": " + what + "\n"; });
  }
  ~Guard() override { set_exception_logger(nullptr); }

  std::uint64_t caught() const { return exception_count() - before_; }

 private:
  std::uint64_t before_ = exception_count();
};

TEST_F(Guard, CatchesAnyException) {
  EXPECT_TRUE(run_guarded("a test", [] {}));
  EXPECT_FALSE(run_guarded("a test", [] { throw std::bad_alloc(); }));
  EXPECT_FALSE(run_guarded("a test", [] { throw std::length_error("too long"); }));
  EXPECT_FALSE(run_guarded("a test", [] { (void)std::get<int>(std::variant<int, char>('x')); }));
  EXPECT_FALSE(run_guarded("a test", [] { throw 7; }));  // NOLINT(hicpp-exception-baseclass): libraries may
  EXPECT_EQ(caught(), 4);
  EXPECT_NE(told.find("a test: too long\n"), std::string::npos);
  EXPECT_NE(told.find("a test: unknown exception\n"), std::string::npos);
}

TEST_F(Guard, SurvivesALogThatThrows) {
  set_exception_logger([](const char*, const char*) { throw std::bad_alloc(); });
  EXPECT_FALSE(run_guarded("a test", [] { throw std::runtime_error("x"); }));
  EXPECT_EQ(caught(), 1);
}

/// Memory may be in an inconsistent state. Accepted messages are on the disk.
TEST(UncaughtDeathTest, EndsTheProcessAndIsLogged) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto run = [](void (*begin)(Loop& loop, Source& timer)) {
    end_by_uncaught();
    Loop loop;
    Source timer = loop.timer([] { throw std::runtime_error("a timer's"); });
    begin(loop, timer);
    loop.run();
  };
  EXPECT_EXIT(run([](Loop& loop, Source& timer) { timer.call_at(loop.now()); }), testing::ExitedWithCode(1),
              "the process: .*a timer's");
  EXPECT_EXIT(run([](Loop& loop, Source&) { loop.post([] { throw std::bad_alloc(); }); }),
              testing::ExitedWithCode(1), "the process: .*bad_alloc");
}

TEST(FaultsDeathTest, CountExceptionsAndOwnSignals) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string file = testing::TempDir() + "adit-faults";
  const auto end = [&file](void (*fault)()) {
    end_by_uncaught();
    count_faults(file.c_str());
    fault();
  };
  EXPECT_EXIT(end([] { std::terminate(); }), testing::ExitedWithCode(1), "");
  EXPECT_EXIT(end([] { std::abort(); }), testing::KilledBySignal(SIGABRT), "");
  EXPECT_EXIT(end([] { (void)::raise(SIGSEGV); }), testing::KilledBySignal(SIGSEGV), "");
  EXPECT_EXIT(end([] { (void)::raise(SIGTERM); }), testing::KilledBySignal(SIGTERM), "")
      << "a signal from outside";
  EXPECT_EQ(std::filesystem::file_size(file), 3u);
  std::filesystem::remove(file);
}

TEST(FaultsDeathTest, CountsAFaultOfAWorkerInTheFileOfItsCounter) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string file = testing::TempDir() + "adit-faults", of_work = file + "-of-work";
  const auto end = [&](bool has_counter) {
    count_faults(file.c_str());
    Loop loop;
    Workers workers(loop, 1);
    workers.submit(
        Urgency::OnTheWay,
        [&] {
          {
            const FaultCounter over(of_work.c_str());
          }
          std::optional<FaultCounter> counter;
          if (has_counter) counter.emplace(of_work.c_str());
          __builtin_trap();
        },
        [] {});
    loop.run();
  };
  EXPECT_EXIT(end(/*has_counter=*/true), testing::KilledBySignal(SIGILL), "");
  EXPECT_EQ(std::filesystem::file_size(file), 1u) << "there is no other file";
  if (!std::filesystem::exists(of_work)) std::ofstream(of_work) << "work\n";  // not in the tested process
  EXPECT_EXIT(end(/*has_counter=*/true), testing::KilledBySignal(SIGILL), "");
  EXPECT_EQ(std::filesystem::file_size(file), 1u);
  EXPECT_EQ(std::filesystem::file_size(of_work), 6u);
  EXPECT_EXIT(end(/*has_counter=*/false), testing::KilledBySignal(SIGILL), "");
  EXPECT_EQ(std::filesystem::file_size(file), 2u);
  EXPECT_EQ(std::filesystem::file_size(of_work), 6u);
  for (const std::string& each : {file, of_work}) std::filesystem::remove(each);
}

TEST(Faults, AreNotCountedIfTheFileCannotBeOpened) {
  EXPECT_EQ(count_faults("/none/adit-faults"), ENOENT);
}

TEST_F(Guard, ReportsAJobThatThrows) {
  Loop loop;
  Workers workers(loop, 1);
  bool done = false, failed = false, next = false;
  workers.submit(
      Urgency::OnTheWay, [] { throw std::bad_alloc(); }, [&] { done = true; }, [&] { failed = true; });
  workers.submit(Urgency::OnTheWay, [] {}, [&] { next = true, loop.stop(); }, [] {});
  loop.run();
  EXPECT_FALSE(done);
  EXPECT_TRUE(failed);
  EXPECT_TRUE(next) << "the worker must continue";
  EXPECT_EQ(caught(), 1);
}

TEST_F(Guard, RunsTheCommonEndOfAJobThatThrows) {
  Loop loop;
  Workers workers(loop, 1);
  workers.submit(Urgency::OnTheWay, [] { throw std::bad_alloc(); }, [&] { loop.stop(); });
  loop.run();
  EXPECT_EQ(caught(), 1);
}

}  // namespace
}  // namespace adit::loop
