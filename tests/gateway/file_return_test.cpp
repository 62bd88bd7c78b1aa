#include "gateway/file_return.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>

#include "host/folder.hpp"
#include "ledger/ledger.hpp"
#include "loop/turn_until.hpp"

namespace adit::gateway {
namespace {

namespace fs = std::filesystem;

class FileReturnTest : public testing::Test {
 protected:
  host::Folder folder_;
  loop::Loop loop_;
  loop::Writer writer_{loop_};
  const std::function<bool()> can_be_read_ = [this] { return ledger::Ledger::can_be_read(folder_.path()); };
  int back_ = 0;
};

TEST_F(FileReturnTest, IsReportedOnce) {
  const FileReturn waits(loop_, writer_, can_be_read_, std::chrono::seconds{0}, [&] { ++back_; });
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return back_ > 0; }));
  for (int i = 0; i < 20; ++i) loop_.turn(std::chrono::milliseconds{5});
  EXPECT_EQ(back_, 1);
}

/// A needless restart of the gateway would cut clients.
TEST_F(FileReturnTest, IsNotReportedWhileAFileIsUnreadable) {
  const std::string in_the_way = folder_.path() + "/ledger";
  std::ofstream(in_the_way) << "no directory";
  const FileReturn waits(loop_, writer_, can_be_read_, std::chrono::seconds{0}, [&] { ++back_; });
  for (int i = 0; i < 40; ++i) loop_.turn(std::chrono::milliseconds{5});
  EXPECT_EQ(back_, 0);
  fs::remove(in_the_way);
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return back_ > 0; }));
}

TEST_F(FileReturnTest, SlowDiskDoesNotBlockTheLoop) {
  bool turned = false;
  std::promise<void> let_go;
  writer_.submit([until = let_go.get_future().share()] { until.wait(); }, [] {});
  const FileReturn waits(loop_, writer_, can_be_read_, std::chrono::seconds{0}, [&] { ++back_; });
  auto other = loop_.timer([&] { turned = true; });
  other.call_at(loop_.now());
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return turned; }));
  EXPECT_EQ(back_, 0);
  let_go.set_value();
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return back_ > 0; }));
}

TEST(FileRetryDelay, DoublesUpToALimit) {
  std::chrono::seconds rest = FileReturn::kRest;
  EXPECT_EQ(longer(rest), 2 * rest);
  for (int i = 0; i < 20; ++i) rest = longer(rest);
  EXPECT_EQ(rest, FileReturn::kLongestRest);
}

}  // namespace
}  // namespace adit::gateway
