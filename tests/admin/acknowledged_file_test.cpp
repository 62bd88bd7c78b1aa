#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "admin/kept_file.hpp"
#include "host/folder.hpp"
#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::admin {
namespace {

using alarms::Acknowledgement;

const Acknowledgement kHeld{
    .id = "report_held:7", .severity = alarms::Severity::Ask, .what = "Report 7 is held", .at = 100};

class AcknowledgedFileTest : public testing::Test {
 protected:
  /// Writes in one process, which then ends. Returns the number of logged lines.
  std::uint64_t keep(const std::vector<std::vector<Acknowledgement>>& each) {
    const std::uint64_t before = host::last_record_number();
    loop::Loop loop;
    loop::Writer writer(loop);
    AcknowledgementFile file(folder_.path(), writer);
    for (const auto& all : each) file.keep(all);
    return wait_for(writer, before);
  }
  std::vector<Acknowledgement> read() {
    loop::Loop loop;
    loop::Writer writer(loop);
    return AcknowledgementFile(folder_.path(), writer).read();
  }
  static std::uint64_t wait_for(loop::Writer& writer, std::uint64_t before) {
    std::atomic<bool> done = false;
    writer.submit([&done] { done = true; }, [] {});
    while (!done) std::this_thread::yield();
    return host::last_record_number() - before;
  }

  host::Folder folder_;
};

TEST_F(AcknowledgedFileTest, SurvivesARestart) {
  EXPECT_TRUE(read().empty()) << "at a first start";
  EXPECT_EQ(keep({{kHeld}}), 0u);
  EXPECT_EQ(read(), std::vector{kHeld});
  struct stat status{};
  ASSERT_EQ(stat((folder_ / "acknowledged.json").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600u);
  EXPECT_EQ(keep({{kHeld}, {}}), 0u);
  EXPECT_TRUE(read().empty());
}

TEST_F(AcknowledgedFileTest, DamagedFileIsEmptyAndLoggedOnce) {
  for (const char* text : {"{\"version\":1,", "", "[]", "{\"version\":9,\"acknowledged\":[]}"}) {
    folder_.put("acknowledged.json", text);
    const std::uint64_t before = host::last_record_number();
    EXPECT_TRUE(read().empty());
    EXPECT_EQ(host::last_record_number() - before, 1u) << text;
  }
}

TEST_F(AcknowledgedFileTest, IsWrittenOnlyAfterAChange) {
  keep({{kHeld}});
  loop::Loop loop;
  loop::Writer writer(loop);
  AcknowledgementFile file(folder_.path(), writer);
  ASSERT_EQ(file.read(), std::vector{kHeld});
  folder_.put("acknowledged.json", "untouched");
  file.keep({kHeld});
  wait_for(writer, 0);
  EXPECT_EQ(host::read_file(folder_ / "acknowledged.json").value(), "untouched");
}

TEST_F(AcknowledgedFileTest, UnreadableFileIsKept) {
  ASSERT_EQ(mkfifo((folder_ / "acknowledged.json").c_str(), 0600), 0);
  loop::Loop loop;
  loop::Writer writer(loop);
  AcknowledgementFile file(folder_.path(), writer);
  EXPECT_TRUE(file.read().empty());
  file.keep({kHeld});
  wait_for(writer, 0);
  EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "acknowledged.json"));
}

TEST_F(AcknowledgedFileTest, WriteErrorIsLoggedOnce) {
  std::filesystem::create_directory(folder_ / "acknowledged.json");
  EXPECT_EQ(keep({{kHeld}, {}, {kHeld}}), 1u);
}

}  // namespace
}  // namespace adit::admin
