// Processes that are killed while they write.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "ledger/state.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::ledger {
namespace {

/// Writes new reports as fast as possible, and prints each number once the report is on the disk.
[[noreturn]] void record(const std::string& state, int told) {
  auto ledger = Ledger::open(state);
  if (!ledger) ::_exit(1);
  std::int64_t number = ledger->known_facts().reports;
  while (write(*ledger, backpack(++number))) {
    if (::write(told, &number, sizeof number) != sizeof number) break;
  }
  ::_exit(1);
}

/// The numbers that a process printed before it was killed.
std::vector<std::int64_t> kill_a_recorder(const State& state, std::chrono::microseconds after) {
  int ends[2] = {-1, -1};
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) record(state.path(), ends[1]);
  ::close(ends[1]);
  const loop::FileDescriptor told(ends[0]);
  std::vector<std::int64_t> numbers;
  const auto hear = [&] {
    std::int64_t number = 0;
    if (::read(told.get(), &number, sizeof number) != sizeof number) return false;
    numbers.push_back(number);
    return true;
  };
  while (numbers.size() < 5 && hear()) continue;
  EXPECT_EQ(Ledger::open(state.path()).error().cause, Error::Cause::InUse);
  std::this_thread::sleep_for(after);
  ::kill(child, SIGKILL);
  while (hear()) continue;
  ::waitpid(child, nullptr, 0);
  return numbers;
}

TEST(LedgerSurvives, AKillAtAnyTime) {
  const State state;
  std::mt19937_64 random(7);
  std::size_t before = 0;
  for (int round = 0; round < 8; ++round) {
    SCOPED_TRACE(round);
    const auto told = kill_a_recorder(state, std::chrono::microseconds(random() % 10000));
    ASSERT_GE(told.size(), 5u);
    const auto ledger = open_or_fail(state.path(), {.reports = told.back(), .log = 1});
    EXPECT_EQ(ledger.damage(), "");
    const auto reports = ledger.reports();
    ASSERT_GE(reports.size(), before + told.size());
    EXPECT_LE(reports.size(), before + told.size() + 1) << "at most the report of the current write";
    for (std::size_t i = 0; i < reports.size(); ++i)
      EXPECT_EQ(reports[i], backpack(static_cast<std::int64_t>(i) + 1));
    before = reports.size();
  }
}

}  // namespace
}  // namespace adit::ledger
