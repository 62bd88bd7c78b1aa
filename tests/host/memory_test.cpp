#include <gmock/gmock.h>

#include <thread>

#include "host/log_line.hpp"

namespace adit::host {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

TEST(LogMemory, ListsRecordsAfterANumber) {
  Memory memory;
  memory.keep(1.5, Level::Notice, "first", {});
  memory.keep(2.5, Level::Warning, "second", std::vector<Field>{{"report", "7"}, {"note", ""}});
  const auto all = memory.records_after(0);
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[0].seq, 1);
  EXPECT_EQ(all[0].at, 1.5);
  EXPECT_EQ(all[1].level, Level::Warning);
  EXPECT_THAT(all[1].fields, ElementsAre(Pair("report", "7"))) << "an empty field is omitted";
  EXPECT_THAT(memory.records_after(1), SizeIs(1));
  EXPECT_THAT(memory.records_after(2), IsEmpty());
  EXPECT_THAT(memory.records_after(99), IsEmpty());
}

TEST(LogMemory, ForgetsTheOldestFirst) {
  Memory memory;
  for (std::size_t i = 0; i < Memory::kMost + 5; ++i) memory.keep(0, Level::Info, "m", {});
  const auto all = memory.records_after(0);
  EXPECT_THAT(all, SizeIs(Memory::kMost));
  EXPECT_EQ(all.front().seq, 6);
  EXPECT_EQ(all.back().seq, Memory::kMost + 5);
}

TEST(LogMemory, IsBoundedForLongRecords) {
  Memory memory;
  const std::vector<Field> fields = {{"why", std::string(1u << 20, 'x')}};
  for (int i = 0; i < 1000; ++i) memory.keep(0, Level::Info, std::string(1u << 16, 'm'), fields);
  std::size_t bytes = 0;
  const auto all = memory.records_after(0);
  for (const Record& record : all) {
    EXPECT_EQ(record.message.size(), Memory::kLongest);
    EXPECT_EQ(record.fields[0].second.size(), Memory::kLongest);
    bytes += record.message.size() + record.fields[0].second.size();
  }
  EXPECT_LE(bytes, Memory::kMostBytes);
  EXPECT_GT(bytes, Memory::kMostBytes / 2);
  EXPECT_EQ(all.back().seq, 1000);
}

TEST(LogMemory, NumbersRecordsOfManyThreadsWithoutAGap) {
  Memory memory;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&memory] {
        for (int j = 0; j < 200; ++j) memory.keep(0, Level::Info, "m", {});
      });
    }
  }
  const auto all = memory.records_after(0);
  ASSERT_THAT(all, SizeIs(800));
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].seq, i + 1);
}

TEST(Log, IsRememberedWithItsFields) {
  const auto before = records_after(0);
  const std::uint64_t last = before.empty() ? 0 : before.back().seq;
  testing::internal::CaptureStderr();
  log(Level::Warning, "report answered", {{"report", "7"}});
  log(Level::Debug, "too fine");
  testing::internal::GetCapturedStderr();
  const auto now = records_after(last);
  ASSERT_THAT(now, SizeIs(1));
  EXPECT_EQ(now[0].message, "report answered");
  EXPECT_THAT(now[0].fields, ElementsAre(Pair("report", "7")));
  EXPECT_GT(now[0].at, 1e9);
}

TEST(TellConsole, ShowsAllButRemembersOnlyTheMessage) {
  const auto before = records_after(0);
  const std::uint64_t last = before.empty() ? 0 : before.back().seq;
  testing::internal::CaptureStderr();
  log_to_console(Level::Notice, "the page asks for this code", {{"code", "31415926"}});
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("code=31415926"));
  const auto now = records_after(last);
  ASSERT_THAT(now, SizeIs(1));
  EXPECT_EQ(now[0].message, "the page asks for this code");
  EXPECT_THAT(now[0].fields, IsEmpty());
}

}  // namespace
}  // namespace adit::host
