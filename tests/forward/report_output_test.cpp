#include "forward/report_output.hpp"

#include <dlfcn.h>
#include <gmock/gmock.h>

#include <cerrno>
#include <filesystem>
#include <optional>

#include "host/folder.hpp"
#include "host/log.hpp"
#include "loop/simulated_time.hpp"
#include "spool/no_file_above.hpp"

namespace {
/// How much the log had said at each flush of a file.
std::vector<std::uint64_t> flushes;
bool fails = false;  // the disk
}  // namespace

// This one comes before the C library's for all of this program.
extern "C" int fdatasync(int file) {
  flushes.push_back(adit::host::logged());
  if (fails) return errno = EIO, -1;
  return reinterpret_cast<int (*)(int)>(::dlsym(RTLD_NEXT, "fdatasync"))(file);
}

namespace adit::forward {
namespace {

using dispatch::Flush;
using dispatch::ReportState;
using namespace std::chrono_literals;

class ReportOutputTest : public testing::Test {
 protected:
  ~ReportOutputTest() override { fails = false; }
  dispatch::Report report(ReportState state) {
    return {.number = 1,
            .report = {"Backpack", {1, 2, 3}},
            .sender = "10.0.0.7",
            .received = 5,
            .changed = 5,
            .state = state,
            .note = "",
            .content_type = "",
            .answer = ""};
  }
  bool write(ReportState state, Flush flush) {
    const std::vector<dispatch::Report> steps{report(state)};
    return output_.write(steps, nullptr, flush);
  }
  /// So much later.
  std::uint64_t logged_after(loop::Duration passed) {
    time_.pass(passed - 1ms);
    time_.pass(loop_, 1ms);
    return host::logged() - said_;
  }

  loop::SimulatedTime time_;
  host::Folder folder_;
  loop::Loop loop_;
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
  ReportOutput output_{loop_, ledger_};
  const std::uint64_t said_ = host::logged();
};

/// Nothing need follow it, and nobody who reads the log slowly is waited for.
TEST_F(ReportOutputTest, FlushesByItselfWhatWasLeftForSoonAndThenLogs) {
  ASSERT_TRUE(write(ReportState::Sending, Flush::Now));
  ASSERT_EQ(logged_after(ReportOutput::kSoon), 1U);
  flushes.clear();
  ASSERT_TRUE(write(ReportState::Answered, Flush::Soon));
  EXPECT_THAT(flushes, testing::IsEmpty()) << "the client is told first";
  ASSERT_EQ(logged_after(ReportOutput::kSoon), 2U);
  EXPECT_THAT(flushes, testing::ElementsAre(said_ + 1)) << "before the log says so";
}

TEST_F(ReportOutputTest, TriesAgainWhileTheLedgerCannotBeWrittenAndSaysOnceThatItCan) {
  fails = true;
  EXPECT_FALSE(write(ReportState::Queued, Flush::Now));
  EXPECT_NE(output_.trouble(), "");
  EXPECT_EQ(logged_after(ReportOutput::kTryEvery), 1U) << "the same trouble";
  fails = false;
  EXPECT_EQ(logged_after(ReportOutput::kTryEvery - 1ms), 1U) << "not yet";
  EXPECT_EQ(logged_after(1ms), 2U);
  EXPECT_EQ(output_.trouble(), "");
  EXPECT_EQ(logged_after(2 * ReportOutput::kTryEvery), 2U);
  EXPECT_TRUE(write(ReportState::Queued, Flush::Now));
}

TEST_F(ReportOutputTest, TriesALedgerAgainThatCouldNotBeWrittenAtTheStart) {
  const host::Folder folder;
  fails = true;
  auto ledger = std::move(*ledger::Ledger::open(folder.path()));
  ReportOutput output(loop_, ledger);
  EXPECT_THAT(output.trouble(), testing::HasSubstr("Input/output error"));
  fails = false;
  EXPECT_EQ(logged_after(ReportOutput::kTryEvery), 2U);
  EXPECT_EQ(output.trouble(), "");
}

TEST_F(ReportOutputTest, KeepsTheFilesOfADamagedLedgerOnceHoweverOftenItTries) {
  const host::Folder folder;
  std::ignore = ledger::Ledger::open(folder.path());
  std::optional<spool::NoFileAbove> full(64u << 10);
  auto ledger = std::move(*ledger::Ledger::open(folder.path(), {.log = 9}));
  ReportOutput output(loop_, ledger);
  for (int tries = 0; tries < 3; ++tries) logged_after(ReportOutput::kTryEvery);
  EXPECT_NE(output.trouble(), "");
  full.reset();
  logged_after(ReportOutput::kTryEvery);
  EXPECT_EQ(output.trouble(), "");
  EXPECT_TRUE(std::filesystem::exists(folder / "ledger/damaged-1"));
  EXPECT_FALSE(std::filesystem::exists(folder / "ledger/damaged-2"));
}

}  // namespace
}  // namespace adit::forward
