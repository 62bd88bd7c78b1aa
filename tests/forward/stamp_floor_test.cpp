#include "forward/stamp_floor.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "host/folder.hpp"
#include "host/log.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;

class StampFloorTest : public testing::Test {
 protected:
  const host::Folder its_folder_;
  const fs::path folder_ = its_folder_.path();
};

TEST_F(StampFloorTest, IsAboveEachIssuedStamp) {
  StampFloor living(folder_.string());
  for (double now = 1.7e9; now < 1.7e9 + 1000; now += 1) {  // each second
    if (const auto due = living.due(now, 5, {})) living.write(*due);
    const double latest = now + 1 + queues::StampShift::kJump;  // until the next call
    ASSERT_GT(StampFloor(folder_.string()).read()->floor, latest);
    ASSERT_LT(StampFloor(folder_.string()).read()->floor, now + 171) << "not far ahead";
  }
}

TEST_F(StampFloorTest, KeepsTheTimeOfDay) {
  StampFloor living(folder_.string());
  living.write(*living.due(1.7e9, 1.8e9, {}));
  EXPECT_DOUBLE_EQ(StampFloor(folder_.string()).read()->wall, 1.8e9);
  EXPECT_FALSE(living.due(1.7e9 + 1, 1.6e9, {}));
  living.is_due();  // the clock was set
  living.write(*living.due(1.7e9 + 1, 1.6e9, {}));
  EXPECT_DOUBLE_EQ(StampFloor(folder_.string()).read()->wall, 1.6e9);
}

TEST_F(StampFloorTest, KeepsTheLeastUntilTheStampsHavePassedIt) {
  StampFloor living(folder_.string());
  EXPECT_EQ(StampFloor(folder_.string()).read()->least, 0);
  living.write({.floor = 1.7e9, .wall = 1.6e9, .least = 1.75e9});
  EXPECT_EQ(StampFloor(folder_.string()).read()->least, 1.75e9);
  living.write(*living.due(1.75e9, 1.6e9, {}));
  EXPECT_EQ(StampFloor(folder_.string()).read()->least, 0);
}

TEST_F(StampFloorTest, KeepsTheSizeOfTheLedger) {
  StampFloor living(folder_.string());
  living.write(*living.due(1.7e9, 1.6e9, {.reports = 5000000000, .log = 12}));
  EXPECT_EQ(StampFloor(folder_.string()).read()->ledger.reports, 5000000000);
  EXPECT_EQ(StampFloor(folder_.string()).read()->ledger.log, 12U);
  for (const char* text : {"1.7e9\n1.6e9\n", "1.7e9\n1.6e9\n0\nmany\n-1\n"}) {
    std::ofstream(folder_ / StampFloor::kFile) << text;
    const StampFloor::Kept kept = StampFloor(folder_.string()).read().value();
    EXPECT_EQ(kept.floor, 1.7e9) << text;
    EXPECT_EQ(kept.ledger.reports, 0) << text;
    EXPECT_EQ(kept.ledger.log, 0U) << text;
  }
}

TEST_F(StampFloorTest, IsWrittenSeldom) {
  StampFloor floor(folder_.string());
  int written = 0;
  for (int second = 0; second < 600; ++second) written += floor.due(1.7e9 + second, 0, {}) ? 1 : 0;
  EXPECT_EQ(written, 4) << "each write takes two flushes";
}

TEST_F(StampFloorTest, IsWrittenTenSecondsAfterAGrowthOrAFailure) {
  StampFloor floor(folder_.string());
  floor.write(*floor.due(1.7e9, 0, {.reports = 1}));
  EXPECT_FALSE(floor.due(1.7e9 + 9, 0, {.reports = 2}));
  const auto grown = floor.due(1.7e9 + 10, 0, {.reports = 2});
  ASSERT_TRUE(grown);
  fs::rename(folder_, folder_.string() + "-elsewhere");
  floor.write(*grown);
  EXPECT_FALSE(floor.due(1.7e9 + 19, 0, {.reports = 2}));
  const auto retry = floor.due(1.7e9 + 20, 0, {.reports = 2});
  ASSERT_TRUE(retry);
  fs::rename(folder_.string() + "-elsewhere", folder_);
  floor.write(*retry);
  EXPECT_FALSE(floor.due(1.7e9 + 169, 0, {.reports = 2}));
}

TEST_F(StampFloorTest, LogsAFailureOnce) {
  StampFloor floor(folder_.string());
  StampFloor for_the_writer = floor;
  const auto logged_by = [&](double seconds) {
    const std::uint64_t before = host::logged();
    for_the_writer.write({.floor = seconds, .wall = seconds});
    return host::logged() - before;
  };
  fs::remove_all(folder_);
  EXPECT_EQ(logged_by(1), 1u);
  EXPECT_EQ(logged_by(2), 0u);
  fs::create_directory(folder_);
  EXPECT_EQ(logged_by(3), 0u);
  fs::remove_all(folder_);
  EXPECT_EQ(logged_by(4), 1u);
}

/// No new file can be created, but the old one can be written.
TEST_F(StampFloorTest, IsWrittenInPlaceOnAFullDisk) {
  StampFloor floor(folder_.string());
  floor.write({.floor = 1.7e9, .wall = 1.6e9, .least = 1.75e9});
  fs::create_directories(folder_ / "stamps.writing" / "in the way");
  const std::uint64_t before = host::logged();
  floor.write({.floor = 1.8e9, .wall = 1.7e9});
  EXPECT_EQ(host::logged(), before);
  EXPECT_EQ(floor.read()->floor, 1.8e9);
  EXPECT_EQ(floor.read()->wall, 1.7e9);
  EXPECT_EQ(floor.read()->least, 0) << "the longer old content is gone";
}

TEST_F(StampFloorTest, IsZeroIfItsFileIsInvalid) {
  EXPECT_EQ(StampFloor(folder_.string()).read()->floor, 0);
  for (const char* text : {"", "soon", "-5", "nan", "inf", "1e300"}) {
    std::ofstream(folder_ / StampFloor::kFile) << text;
    const StampFloor::Kept kept = StampFloor(folder_.string()).read().value();
    EXPECT_EQ(kept.floor, 0) << text;
    EXPECT_EQ(kept.wall, 0) << text;
  }
}

}  // namespace
}  // namespace adit::forward
