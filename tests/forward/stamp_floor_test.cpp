#include "forward/stamp_floor.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "host/log.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;

class StampFloorTest : public testing::Test {
 protected:
  StampFloorTest() {
    std::string pattern = fs::temp_directory_path() / "adit-floor-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  ~StampFloorTest() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(StampFloorTest, IsNeverBelowAStampThatWasGivenOutWheneverThePowerIsCut) {
  StampFloor living(folder_.string());
  for (double now = 1.7e9; now < 1.7e9 + 100; now += 1) {  // once a second
    if (const auto floor = living.due(now)) living.write(*floor);
    const double latest = now + 1 + lanes::StampShift::kJump;  // until it is asked again
    ASSERT_GT(StampFloor(folder_.string()).read(), latest);
    ASSERT_LT(StampFloor(folder_.string()).read(), now + 60) << "nor far ahead";
  }
}

TEST_F(StampFloorTest, IsWrittenSeldom) {
  StampFloor floor(folder_.string());
  int written = 0;
  for (int second = 0; second < 100; ++second) written += floor.due(1.7e9 + second) ? 1 : 0;
  EXPECT_EQ(written, 10);
}

TEST_F(StampFloorTest, IsComplainedOfOnceUntilItCanBeWrittenAgain) {
  StampFloor floor(folder_.string());
  StampFloor for_the_writer = floor;
  const auto logged_by = [&](double seconds) {
    const std::uint64_t before = host::logged();
    for_the_writer.write(seconds);
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

TEST_F(StampFloorTest, SaysNothingWhereNothingIsKnown) {
  EXPECT_EQ(StampFloor(folder_.string()).read(), 0);
  for (const char* text : {"", "soon", "-5", "nan", "inf", "1e300"}) {
    std::ofstream(folder_ / StampFloor::kFile) << text;
    EXPECT_EQ(StampFloor(folder_.string()).read(), 0) << text;
  }
}

}  // namespace
}  // namespace adit::forward
