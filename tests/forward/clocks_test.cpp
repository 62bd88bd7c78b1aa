#include "forward/clocks.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

#include "host/folder.hpp"
#include "journal/left_in.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

constexpr double kFar = 1000;  // seconds

class ClocksTest : public testing::Test {
 protected:
  /// Continues from the files of the last process.
  void restart(const std::string& boot = "b") {
    clocks_.reset();
    journal_.reset();
    journal_.emplace(loop_, folder_.path() + "/journal");
    journal::HandoverState carried = journal_->read();
    clocks_.emplace(loop_, *journal_, folder_.path());
    clocks_->restore(carried, boot, newest_);
  }
  double now() const { return loop_.stamp_now(); }
  /// Stamp of a robot's pose.
  icd::Stamp stamped(double stamp) {
    const icd::StateUpdate update{.header = {stamp}, .poses = {{*icd::RobotName::parse("r1"), {}}}};
    return *clocks_->stamp_poses(update, {.address = "10.0.0.5"}).at(0).stamp;
  }
  void keep() {
    clocks_->keep(disk_, {});
    bool is_written = false;
    disk_.submit([] {}, [&] { is_written = true; });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return is_written; }));
  }

  double newest_ = 0;  // in the ledger
  host::Folder folder_;
  loop::Loop loop_;
  loop::Writer disk_{loop_};
  std::optional<journal::Journal> journal_;
  std::optional<Clocks> clocks_;
};

TEST_F(ClocksTest, KeepTheOffsetOfASenderAcrossARestart) {
  restart();
  const icd::Stamp first = stamped(50);
  EXPECT_NEAR(first, now(), 0.1);
  restart();
  EXPECT_NEAR(stamped(50.3), first + 0.3, 1e-6);
}

TEST_F(ClocksTest, KeepAnUnreadableStampFloor) {
  const std::string file = folder_ / StampFloor::kFile, elsewhere = folder_ / "elsewhere";
  const double floor = now() + kFar;
  StampFloor(folder_.path()).write({.floor = floor, .wall = now()});
  std::filesystem::rename(file, elsewhere);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  restart();
  EXPECT_EQ(clocks_->unread(), "the last time stamps cannot be read: " + file + ": is not a regular file");
  keep();
  ASSERT_TRUE(std::filesystem::is_fifo(file));
  std::filesystem::rename(elsewhere, file);
  restart();
  EXPECT_GE(now(), floor);
}

TEST(StampFloor, RemembersWhatIsKnownOfTheLedger) {
  const host::Folder folder;
  StampFloor floor(folder.path());
  floor.write({.floor = 50, .wall = 40, .least = 30, .ledger = {.reports = 2, .log = 3, .last = 9}});
  floor.remember({.reports = 4, .log = 1, .last = 12});
  EXPECT_EQ(floor.read(),
            (StampFloor::StoredFloor{
                .floor = 50, .wall = 40, .least = 30, .ledger = {.reports = 4, .log = 3, .last = 12}}));
  folder.put(StampFloor::kFile, "half");
  floor.remember({.reports = 4});
  EXPECT_TRUE(floor.read()->is_damaged) << "the next start tells it";
}

TEST_F(ClocksTest, KeepStampsAtAnyTimeOfDayAfterARestart) {
  for (const double set : {-kFar, kFar}) {
    restart();
    const icd::Stamp first = stamped(50);
    loop_.set_stamp(now() + set);  // time of day changed during the stop
    restart();
    EXPECT_NEAR(stamped(50.3), first + 0.3, 1e-6) << set;
    EXPECT_NEAR(now(), first, 1) << set;
  }
}

TEST_F(ClocksTest, ContinueFromTheFloorWithoutAHardwareClock) {
  restart();
  const double before = now();
  keep();
  loop_.set_stamp(before - kFar);
  loop_.set_wall(before - kFar);
  restart("another start");
  EXPECT_GE(now(), before);
  EXPECT_NEAR(clocks_->clock_step().seconds_between(before, now()), 0, 1) << "the time off is unknown";
  EXPECT_NEAR(loop_.wall_now(), before, 1) << "the last known time";
  EXPECT_NEAR(loop_.wall_offset(), 0, 1) << "not ahead of the system's clock";
}

TEST_F(ClocksTest, ContinueFromTheLedgerIfTheFloorIsLost) {
  const std::string file = folder_ / StampFloor::kFile;
  restart();
  EXPECT_EQ(clocks_->damage(), "") << "the first start";
  newest_ = now() + kFar;
  restart("without a file");
  EXPECT_GE(now(), newest_);
  EXPECT_EQ(clocks_->damage(), "their file is missing or damaged");
  StampFloor(folder_.path()).write({.floor = newest_});
  newest_ += kFar;
  restart("an older file");
  EXPECT_GE(now(), newest_);
  EXPECT_EQ(clocks_->damage(), "their file is older than the ledger");
  folder_.put(StampFloor::kFile, "half");
  restart("half a file");
  EXPECT_EQ(clocks_->damage(), "their file is damaged");
  StampFloor(folder_.path()).write({.floor = newest_});
  for (const double before : {0.0, 10.0}) {  // the power fails right after a start
    newest_ += before;
    restart("a file, " + std::to_string(before));
    EXPECT_GE(now(), newest_);
    EXPECT_EQ(clocks_->damage(), "") << before;
  }
}

/// The floor is used, and stamps step back if the operator resets the box.
TEST_F(ClocksTest, StepBackFromAFloorFarAheadAfterAReset) {
  const double before = now(), days = 10 * 86400;
  StampFloor(folder_.path()).write({.floor = before + days, .wall = before});
  restart();
  EXPECT_GE(now(), before + days) << "its checksum is good";
  EXPECT_EQ(clocks_->lead(), 0) << "no known time";
  clocks_->set_known_time(before + days - StampFloor::kMostAhead + 10);
  EXPECT_EQ(clocks_->lead(), 0);
  clocks_->set_known_time(before);
  EXPECT_NEAR(clocks_->lead(), days, 1);
  keep();
  newest_ = now();  // a report
  loop_.set_stamp(before);
  restart("another start");
  EXPECT_GE(now(), newest_);
  StampFloor(folder_.path()).forget();
  for (const char* const boot : {"after the reset", "another one"}) {
    loop_.set_stamp(before);
    restart(boot);
    EXPECT_NEAR(now(), before, 2 * StampFloor::kAhead);
    EXPECT_EQ(clocks_->damage(), "");
    keep();
  }
}

/// The box's clock is ten years ahead at a start. It may be wrong, or the box was stored.
TEST_F(ClocksTest, FollowAClockFarAheadOnceAnotherSourceAgrees) {
  constexpr double kYears = 10 * 365 * 86400.0;
  const double before = now();
  for (const bool agrees : {false, true}) {
    std::filesystem::remove(folder_.path() + '/' + StampFloor::kFile);
    loop_.set_stamp(before);
    loop_.set_wall(before);
    restart("first");
    keep();
    const auto boot = [&](const char* name) {
      loop_.set_stamp(before + kYears);
      loop_.set_wall(before + kYears);
      restart(name);
    };
    boot("second");
    EXPECT_NEAR(now(), before, 2 * StampFloor::kAhead);
    EXPECT_TRUE(clocks_->correct(before + kYears));
    EXPECT_NEAR(clocks_->clock_step().seconds_between(before, now()), kYears, 1) << "the box was off";
    clocks_->set_known_time(agrees ? before + kYears : before);
    keep();
    boot("third");
    EXPECT_NEAR(now(), before + (agrees ? kYears : 0), 3 * StampFloor::kAhead) << agrees;
  }
}

/// A season in a store.
TEST_F(ClocksTest, FollowAClockThatIsAheadByLessThanASeason) {
  restart();
  keep();
  const double later = now() + 199 * 86400;
  loop_.set_stamp(later);
  restart("another start");
  EXPECT_NEAR(now(), later, 1);
}

TEST_F(ClocksTest, ContinueAfterTheStampsOfTheFirstBox) {
  restart();
  stamped(50);
  const double least = now() + kFar;
  StampFloor(folder_.path()).write({.floor = least, .wall = 0, .least = least});
  restart();
  EXPECT_GE(stamped(50.3), least) << "of a known sender";
  restart();
  EXPECT_GE(now(), least);
}

TEST_F(ClocksTest, LeaveStampsOfTheFirstBoxAsWritten) {
  restart();
  const double there = now(), least = there + 165;
  StampFloor(folder_.path()).write({.floor = least, .wall = 0, .least = least});
  restart();
  keep();
  restart();  // reads what keep() wrote
  EXPECT_EQ(clocks_->time_of_day(there), there);
  EXPECT_NEAR(clocks_->time_of_day(now()), loop_.wall_now(), 1) << "a stamp of this box";
}

TEST_F(ClocksTest, FollowTheHardwareClockAfterABoot) {
  restart();
  keep();
  const double later = now() + kFar;
  loop_.set_stamp(later);
  loop_.set_wall(later);
  restart("another start");
  EXPECT_NEAR(now(), later, 1);
  EXPECT_NEAR(loop_.wall_now(), later, 1);
}

TEST_F(ClocksTest, DetectAClockStepWithoutElapsedTime) {
  restart();
  EXPECT_EQ(clocks_->clock_step(), dispatch::ClockStep()) << "first start";
  const double before = now();
  loop_.set_wall(before + 5 * kFar);
  keep();
  loop_.set_stamp(before + 6 * kFar);  // the clock went on during the stop
  loop_.set_wall(before + 6 * kFar);
  restart("another start");
  restart("another start");  // a process start; the step is unconfirmed
  EXPECT_TRUE(clocks_->correct(loop_.wall_now()));
  EXPECT_NEAR(clocks_->clock_step().by, 5 * kFar, 1);
  EXPECT_NEAR(clocks_->clock_step().seconds_between(before, now()), kFar, 1) << "time off";
  const dispatch::ClockStep step = clocks_->clock_step();
  restart("another start");
  EXPECT_EQ(clocks_->clock_step(), step) << "kept at a process start";
  EXPECT_FALSE(clocks_->correct(loop_.wall_now() + kFar));
}

TEST_F(ClocksTest, MeasureTheTimeThatTheMachineWasOff) {
  struct Case {
    std::optional<double> there;  // ahead of the last known time
    double off;
  };
  for (const Case& each : {Case{{}, 0}, {60, 60}, {-kFar, 0}, {2 * kFar, kFar}}) {
    restart("first");
    keep();
    const double before = now(), known = loop_.wall_now();
    loop_.set_stamp(before + kFar);  // the clock is ahead at the start
    loop_.set_wall(known + kFar);
    restart("second");
    if (each.there) clocks_->correct(known + *each.there);
    EXPECT_NEAR(clocks_->clock_step().seconds_between(before, now()), each.off, 1) << each.there.value_or(0);
    std::filesystem::remove(folder_.path() + '/' + StampFloor::kFile);
  }
}

TEST_F(ClocksTest, KeepAClockThatWasSetBack) {
  restart();
  keep();
  const double before = now();
  loop_.set_wall(before - kFar);
  restart();
  EXPECT_NEAR(loop_.wall_now(), before - kFar, 1);
}

/// In a state of one robot or of several.
TEST_F(ClocksTest, HaveOneOffsetPerRobotAndAddress) {
  restart();
  const icd::StateUpdate both{
      .header = {50}, .poses = {{*icd::RobotName::parse("r1"), {}}, {*icd::RobotName::parse("r2"), {}}}};
  const icd::Stamp first = *clocks_->stamp_poses(both, {.address = "10.0.0.5"}).at(0).stamp;
  loop_.set_stamp(now() + 2);
  EXPECT_NEAR(stamped(50.5), first + 0.5, 1e-6);
}

TEST_F(ClocksTest, HaveOneOffsetPerMessageOfMarkers) {
  restart();
  icd::MarkersUpdate update;
  for (int i = 0; i < 5000; ++i) update.markers.emplace_back().ns = std::to_string(i);
  for (icd::Marker& marker : update.markers) marker.header.stamp = 50;
  clocks_->stamp(update, {.address = "10.0.0.5"});
  EXPECT_EQ(journal::left_in(folder_.path() + "/journal").senders().clocks().size(), 1u);
}

TEST_F(ClocksTest, LimitTheOffsetsOfAState) {
  restart();
  icd::StateUpdate update{.header = {50}, .poses = {}};
  for (int i = 0; i < 500; ++i) update.poses.push_back({*icd::RobotName::parse(std::to_string(i)), {}});
  clocks_->stamp_poses(update, {.address = "10.0.0.5"});
  EXPECT_LE(journal::left_in(folder_.path() + "/journal").senders().clocks().size(),
            queues::StampShift::kMostOfAddress);
}

}  // namespace
}  // namespace adit::forward
