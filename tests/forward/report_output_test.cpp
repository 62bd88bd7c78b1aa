#include "forward/report_output.hpp"

#include <dlfcn.h>
#include <gmock/gmock.h>

#include "host/folder.hpp"
#include "host/log.hpp"
#include "loop/turn_until.hpp"

namespace {
/// How much the log had said at each flush of a file.
std::vector<std::uint64_t> flushes;
}  // namespace

// SQLite is a shared library: this stands before the C library's own for all of this program.
extern "C" int fdatasync(int file) {
  flushes.push_back(adit::host::logged());
  return reinterpret_cast<int (*)(int)>(::dlsym(RTLD_NEXT, "fdatasync"))(file);
}

namespace adit::forward {
namespace {

using dispatch::Flush;
using dispatch::ReportState;

class ReportOutputTest : public testing::Test {
 protected:
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
  /// Turns the loop until the log has said so much more; whether it has.
  bool says(std::uint64_t more) {
    return loop::turn_until(loop_, [&] { return host::logged() >= said_ + more; }) &&
           host::logged() == said_ + more;
  }

  host::Folder folder_;
  loop::Loop loop_;
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
  ReportOutput output_{loop_, ledger_};
  const std::uint64_t said_ = host::logged();
};

/// Nothing need follow it, and nobody who reads the log slowly is waited for.
TEST_F(ReportOutputTest, FlushesByItselfWhatWasLeftForSoonAndThenLogs) {
  ASSERT_TRUE(write(ReportState::Sending, Flush::Now));
  ASSERT_TRUE(says(1));
  flushes.clear();
  ASSERT_TRUE(write(ReportState::Answered, Flush::Soon));
  EXPECT_THAT(flushes, testing::IsEmpty()) << "the client is told first";
  ASSERT_TRUE(says(2));
  EXPECT_THAT(flushes, testing::ElementsAre(said_ + 1)) << "before the log says so";
}

}  // namespace
}  // namespace adit::forward
