#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "forward/clocks.hpp"
#include "host/folder.hpp"
#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;

class StampFloorTest : public testing::Test {
 protected:
  static constexpr StampFloor::StoredFloor kWritten{.floor = 1.7e9,
                                                    .wall = 1.6e9,
                                                    .least = 1.5e9,
                                                    .ledger = {.reports = 7, .log = 3},
                                                    .lead = 5,
                                                    .overruled = 1.4e9};
  static constexpr std::size_t kCopy = 112;  // bytes of a copy

  StampFloor::StoredFloor read() const { return StampFloor(folder_.string()).read().value(); }
  std::string bytes() const { return host::read_file(folder_ / StampFloor::kFile).value(); }
  void put(std::string_view file) const {
    std::ofstream(folder_ / StampFloor::kFile, std::ios::binary) << file;
  }

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
  living.make_due();  // the clock was set
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
    const std::uint64_t before = host::last_record_number();
    for_the_writer.write({.floor = seconds, .wall = seconds});
    return host::last_record_number() - before;
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
  const std::uint64_t before = host::last_record_number();
  floor.write({.floor = 1.8e9, .wall = 1.7e9});
  EXPECT_EQ(host::last_record_number(), before);
  EXPECT_EQ(floor.read()->floor, 1.8e9);
  EXPECT_EQ(floor.read()->wall, 1.7e9);
  EXPECT_EQ(floor.read()->least, 0) << "the longer old content is gone";
}

TEST_F(StampFloorTest, IsZeroIfItsFileIsInvalid) {
  EXPECT_EQ(read().floor, 0);
  for (const char* text : {"", "soon", "1700000000.0\n1600000000.0\n0.0\n7\n3\n"}) {
    const std::uint64_t before = host::last_record_number();
    put(text);
    EXPECT_EQ(read(), StampFloor::StoredFloor{.is_damaged = true}) << text;
    EXPECT_EQ(host::last_record_number(), before + 1) << text;
  }
}

TEST_F(StampFloorTest, SurvivesAnyWrongByte) {
  StampFloor(folder_.string()).write(kWritten);
  const std::string whole = bytes();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    if (whole[at] == 0 && at % 4096 >= kCopy) continue;  // between the copies
    std::string wrong = whole;
    wrong[at] = static_cast<char>(wrong[at] ^ 1);
    put(wrong);
    ASSERT_EQ(read(), kWritten) << at;
  }
}

TEST_F(StampFloorTest, NeverUsesAPartOfACopy) {
  StampFloor(folder_.string()).write(kWritten);
  const std::string whole = bytes();
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    if (size > kCopy && size < whole.size() - kCopy) continue;  // between the copies
    put(whole.substr(0, size));
    ASSERT_EQ(read(), size < kCopy ? StampFloor::StoredFloor{.is_damaged = true} : kWritten) << size;
  }
}

/// A file is written over, and the power fails: each sector is the old or the new one.
TEST_F(StampFloorTest, UsesTheHigherOfTwoCopies) {
  const StampFloor::StoredFloor later{.floor = 1.9e9, .wall = 1.8e9, .ledger = {.reports = 8, .log = 4}};
  StampFloor(folder_.string()).write(kWritten);
  const std::string before = bytes();
  StampFloor(folder_.string()).write(later);
  const std::string after = bytes();
  for (const auto& [first, second] : {std::pair(before, after), std::pair(after, before)}) {
    put(first.substr(0, 512) + second.substr(512));
    EXPECT_EQ(read(), later);
  }
}

TEST_F(StampFloorTest, ForgetsABoundThatIsFarAhead) {
  StampFloor floor(folder_.string());
  for (const double ahead : {-1.0, StampFloor::kMostAhead}) {
    floor.write({.floor = 1.7e9, .lead = ahead});
    floor.forget();
    EXPECT_EQ(read().floor, 1.7e9) << ahead;
  }
  floor.write({.floor = 1.7e9, .wall = 1.6e9, .ledger = {.reports = 7, .log = 3}, .lead = 1e8});
  floor.forget();
  EXPECT_EQ(read(), (StampFloor::StoredFloor{.ledger = {.reports = 7, .log = 3}, .overruled = 1.7e9}));
}

}  // namespace
}  // namespace adit::forward
