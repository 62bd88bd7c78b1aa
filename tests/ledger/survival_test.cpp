#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "ledger/folder.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::ledger {
namespace {

using testing::HasSubstr;

/// A child process that records reports as fast as it can and tells each number once add() has given it.
class Recorder {
 public:
  explicit Recorder(const Folder& folder) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::pipe(ends), 0);
    child_ = ::fork();
    if (child_ == 0) {
      record(folder, ends[1]);
      ::_exit(1);
    }
    ::close(ends[1]);
    told_ = loop::FileDescriptor(ends[0]);
  }

  ~Recorder() { kill(); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Waits until it has told that many numbers.
  void wait_for(std::size_t numbers) {
    while (numbers_.size() < numbers && hear()) continue;
  }
  /// Ends it at once and gives all the numbers that it told.
  const std::vector<std::int64_t>& kill() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      while (hear()) continue;
      ::waitpid(std::exchange(child_, -1), nullptr, 0);
    }
    return numbers_;
  }

 private:
  static void record(const Folder& folder, int told) {
    auto ledger = Ledger::open(folder.text());
    while (ledger) {
      const auto number = ledger->add(backpack(), "10.0.0.7", "received", 1);
      if (!number || ::write(told, &*number, sizeof *number) != sizeof *number) return;
    }
  }

  bool hear() {
    std::int64_t number = 0;
    if (::read(told_.get(), &number, sizeof number) != sizeof number) return false;
    numbers_.push_back(number);
    return true;
  }

  pid_t child_ = -1;
  loop::FileDescriptor told_;
  std::vector<std::int64_t> numbers_;
};

TEST(LedgerSurvives, AKillAtAnyMoment) {
  const Folder folder;
  std::mt19937_64 random(7);
  std::size_t before = 0;
  for (int round = 0; round < 8; ++round) {
    SCOPED_TRACE(round);
    Recorder recorder(folder);
    recorder.wait_for(5);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 10000));
    const auto& told = recorder.kill();
    ASSERT_GE(told.size(), 5u);
    const auto ledger = open_or_fail(folder);
    EXPECT_EQ(ledger.damage(), "");
    const auto all = ledger.all();
    ASSERT_TRUE(all);
    for (const auto number : told) {
      EXPECT_EQ(find_or_fail(ledger, number).report, backpack());
    }
    EXPECT_LE(all->size(), before + told.size() + 1) << "at most the one that was being recorded";
    before = all->size();
  }
}

TEST(LedgerSurvives, ASecondProcessThatWantsItToo) {
  const Folder folder;
  {
    Recorder recorder(folder);
    recorder.wait_for(1);
    const auto ledger = Ledger::open(folder.text());
    ASSERT_FALSE(ledger);
    EXPECT_THAT(ledger.error().what, HasSubstr("another process"));
    EXPECT_FALSE(std::filesystem::exists(folder.file() + ".damaged-1"));
  }
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

/// No file of this process grows past `bytes`: what a full disk does, for this process alone.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  sighandler_t handler_ = SIG_DFL;
};

/// Adds until one fails, and gives its error; the numbers of those that did not go to `numbers`.
Error fill(Ledger& ledger, std::vector<std::int64_t>& numbers) {
  while (numbers.size() < 10000) {
    const auto number = ledger.add(backpack(), "10.0.0.7", "received", 1);
    if (!number) return number.error();
    numbers.push_back(*number);
  }
  return {"it never failed", false};
}

TEST(LedgerSurvives, AFullDiskAndSaysSo) {
  const Folder folder;
  std::vector<std::int64_t> numbers;
  {
    auto ledger = open_or_fail(folder);
    {
      const FullDisk full(100000);
      const Error error = fill(ledger, numbers);
      EXPECT_TRUE(error.full) << error.what;
      EXPECT_GT(numbers.size(), 3u);
      EXPECT_FALSE(ledger.add(backpack(), "", "received", 2)) << "it is still full";
      Entry entry = find_or_fail(ledger, 1);
      entry.answer.assign(50000, 'x');
      const auto changed = ledger.change(entry, 2);
      ASSERT_FALSE(changed);
      EXPECT_TRUE(changed.error().full) << changed.error().what;
      EXPECT_EQ(ledger.all()->size(), numbers.size()) << "what was recorded can still be read";
    }
    const auto next = ledger.add(backpack(), "", "received", 3);
    ASSERT_TRUE(next) << "there is space again: " << next.error().what;
    numbers.push_back(*next);
  }
  const auto ledger = open_or_fail(folder);
  EXPECT_EQ(ledger.damage(), "");
  const auto all = ledger.all();
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(all->at(i).number, numbers[i]);
}

TEST(LedgerSurvives, BeingOpenedOnAFullDisk) {
  const Folder folder;
  {
    auto ledger = open_or_fail(folder);
    ASSERT_TRUE(ledger.add(backpack(), "", "received", 1));
  }
  {
    const FullDisk full(0);
    auto ledger = open_or_fail(folder);
    EXPECT_EQ(ledger.all()->size(), 1u);
    const auto added = ledger.add(backpack(), "", "received", 2);
    ASSERT_FALSE(added);
    EXPECT_TRUE(added.error().full) << added.error().what;
  }
  EXPECT_EQ(open_or_fail(folder).all()->size(), 1u);
}

TEST(LedgerSurvives, ANewFolderOnAFullDiskAndSaysSo) {
  const Folder folder;
  {
    const FullDisk full(0);
    const auto ledger = Ledger::open(folder.text());
    ASSERT_FALSE(ledger);
    EXPECT_TRUE(ledger.error().full) << ledger.error().what;
  }
  EXPECT_EQ(open_or_fail(folder).damage(), "");
}

}  // namespace
}  // namespace adit::ledger
