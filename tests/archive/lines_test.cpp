#include <gtest/gtest.h>

#include "archive/record_kinds.hpp"

namespace adit::archive {
namespace {

using std::chrono::seconds;

loop::Instant at(int second) {
  return loop::Instant{} + std::chrono::hours(1) + seconds(second);
}

TEST(Lines, AreWrittenEach150SecondsOnAnIdleBox) {
  Lines lines;
  int writes = 0;
  for (int second = 0; second < 600; ++second) {
    if (second % 2 == 0) lines.add("plots", false);
    if (!lines.is_due(at(second))) continue;
    EXPECT_FALSE(lines.pop(at(second)).empty());
    ++writes;
  }
  EXPECT_EQ(writes, 4);
}

TEST(Lines, AreDueAtOnceWithNews) {
  Lines lines;
  lines.add("1", false);
  EXPECT_EQ(lines.pop(at(0)), "1");
  lines.add("2", false);
  EXPECT_FALSE(lines.is_due(at(1)));
  lines.add("3", true);
  EXPECT_TRUE(lines.is_due(at(1)));
  EXPECT_EQ(lines.pop(at(1)), "23");
  EXPECT_FALSE(lines.is_due(at(600))) << "no lines to write";
}

TEST(Lines, OfAFailedWriteAreDueAgainFirst) {
  Lines lines;
  lines.add("1", false);
  const std::string taken = lines.pop(at(0));
  lines.add("2", false);
  lines.give_back(taken);
  EXPECT_TRUE(lines.is_due(at(1)));
  EXPECT_EQ(lines.pop(at(1)), "12");
}

TEST(Lines, BeyondTheWriteLimitStayDue) {
  Lines lines;
  for (int i = 0; i < 3; ++i) lines.add(std::string(kLargestRecord / 2, 'x'), false);
  EXPECT_EQ(lines.pop(at(0)).size(), kLargestRecord / 2 * 2);
  EXPECT_TRUE(lines.is_due(at(1)));
  lines.trim_to(kLargestRecord / 4);
  EXPECT_EQ(lines.bytes(), 0U) << "the oldest are dropped";
}

}  // namespace
}  // namespace adit::archive
