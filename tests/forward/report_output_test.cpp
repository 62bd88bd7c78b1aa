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
/// Number of log lines at each flush.
std::vector<std::uint64_t> flushes;
bool fails = false;  // the disk fails
}  // namespace

// Replaces the C library's function in this program.
extern "C" int fdatasync(int file) {
  flushes.push_back(adit::host::last_record_number());
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
  /// Lines logged since the start, after this time has passed.
  std::uint64_t logged_after(loop::Duration passed) {
    time_.pass(passed - 1ms);
    time_.pass(loop_, 1ms);
    return host::last_record_number() - said_;
  }

  loop::SimulatedTime time_;
  host::Folder folder_;
  loop::Loop loop_;
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
  ReportOutput output_{loop_, ledger_};
  const std::uint64_t said_ = host::last_record_number();
};

/// The flush needs no later event. A slow reader of the log delays nothing.
TEST_F(ReportOutputTest, FlushesDelayedStepsAndThenLogs) {
  ASSERT_TRUE(write(ReportState::Sending, Flush::Now));
  ASSERT_EQ(logged_after(ReportOutput::kSoon), 1U);
  flushes.clear();
  ASSERT_TRUE(write(ReportState::Answered, Flush::Soon));
  EXPECT_THAT(flushes, testing::IsEmpty()) << "the client is answered first";
  ASSERT_EQ(logged_after(ReportOutput::kSoon), 2U);
  EXPECT_THAT(flushes, testing::ElementsAre(said_ + 1)) << "before the log line";
}

TEST_F(ReportOutputTest, RetriesWritesAndLogsTheRecovery) {
  fails = true;
  EXPECT_FALSE(write(ReportState::Queued, Flush::Now));
  EXPECT_NE(output_.trouble(), "");
  EXPECT_EQ(logged_after(ReportOutput::kTryEvery), 1U) << "the same error";
  fails = false;
  EXPECT_EQ(logged_after(ReportOutput::kTryEvery - 1ms), 1U) << "too early";
  EXPECT_EQ(logged_after(1ms), 2U);
  EXPECT_EQ(output_.trouble(), "");
  EXPECT_EQ(logged_after(2 * ReportOutput::kTryEvery), 2U);
  EXPECT_TRUE(write(ReportState::Queued, Flush::Now));
}

TEST_F(ReportOutputTest, RetriesALedgerThatFailedAtTheStart) {
  const host::Folder folder;
  fails = true;
  auto ledger = std::move(*ledger::Ledger::open(folder.path()));
  ReportOutput output(loop_, ledger);
  EXPECT_THAT(output.trouble(), testing::HasSubstr("Input/output error"));
  fails = false;
  EXPECT_EQ(logged_after(ReportOutput::kTryEvery), 2U);
  EXPECT_EQ(output.trouble(), "");
}

TEST_F(ReportOutputTest, KeepsADamagedLedgerOnce) {
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
