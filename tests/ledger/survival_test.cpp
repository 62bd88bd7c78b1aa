#include <gmock/gmock.h>
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

/// A child process that writes new reports as fast as it can and tells the number of each that is on disk.
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
    if (!ledger) return;
    const auto before = ledger->reports();
    std::int64_t number = before && !before->empty() ? before->back().number : 0;
    while (ledger::write(*ledger, backpack(++number))) {
      if (::write(told, &number, sizeof number) != sizeof number) return;
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
    const auto reports = ledger.reports();
    ASSERT_TRUE(reports);
    ASSERT_GE(reports->size(), before + told.size());
    EXPECT_LE(reports->size(), before + told.size() + 1) << "at most the one that was being written";
    for (std::size_t i = 0; i < reports->size(); ++i) {
      EXPECT_EQ(reports->at(i), backpack(static_cast<std::int64_t>(i) + 1));
    }
    before = reports->size();
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

TEST(LedgerSurvives, ASecondOpeningWhileItsLogIsHalfWritten) {
  const Folder folder;
  {
    auto open = open_or_fail(folder);
    ASSERT_TRUE(write(open, backpack(1)));
    const std::string log = folder.file() + "-wal", written = bytes_of(log);
    save(log, "half" + written.substr(4));
    const auto second = Ledger::open(folder.text());
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().what, HasSubstr("another process"));
    save(log, written);
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file() + ".damaged-1"));
  EXPECT_EQ(find_or_fail(open_or_fail(folder), 1), backpack(1));
}

}  // namespace
}  // namespace adit::ledger
