#include "alarms/board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "alarms/alike.hpp"
#include "alarms/words.hpp"

namespace adit::alarms {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

const Condition kSilent{
    .id = "robot_silent:uav5", .side = Side::Robot, .since = 70, .what = "uav5 is silent"};
const Condition kHeld{
    .id = "report_held:7", .severity = Severity::Ask, .since = 50, .what = "Report 7 is held"};
const Condition kFew{.id = "reports_left", .severity = Severity::Wait, .what = "5 reports are left"};

auto id_is(const char* id) {
  return Field(&Alarm::id, id);
}

TEST(Board, ShowsBadBeforeAskBeforeWaitThenTheOldestFirst) {
  Condition older = kSilent;
  older.id = "robot_silent:uav4";
  older.since = 60;
  EXPECT_THAT(Board().shown({kFew, kHeld, kSilent, older}, 100),
              ElementsAre(id_is("robot_silent:uav4"), id_is("robot_silent:uav5"), id_is("report_held:7"),
                          id_is("reports_left")));
}

TEST(Board, KnowsSinceWhenItIsSo) {
  Board board;
  board.take({kFew, kSilent}, 100);
  const auto shown = board.shown({kFew, kSilent}, 160);
  EXPECT_EQ(shown[0].since, 70) << "as the rules say";
  EXPECT_EQ(shown[1].since, 100) << "as it was found";
}

TEST(Board, RemembersTheLastThatWent) {
  Board board;
  board.take({kSilent}, 100);
  board.take({}, 111);
  EXPECT_THAT(board.over(), ElementsAre(Over{.id = "robot_silent:uav5",
                                             .severity = Severity::Bad,
                                             .side = Side::Robot,
                                             .was = "uav5 was silent",
                                             .since = 70,
                                             .until = 111}));
  for (int i = 0; i < 50; ++i) {
    board.take({kHeld}, 200 + 2 * i);
    board.take({}, 201 + 2 * i);
  }
  EXPECT_EQ(board.over().size(), Board::kMostOver);
  EXPECT_EQ(board.over().front().until, 299) << "the newest first";
}

TEST(Board, KeepsWhatIsAcknowledgedQuietWhileItStaysAsItIs) {
  Board board;
  board.take({kSilent, kHeld}, 100);
  ASSERT_TRUE(board.acknowledge(kSilent.id));
  board.take({kSilent, kHeld}, 101);
  const auto shown = board.shown({kSilent, kHeld}, 102);
  EXPECT_TRUE(shown[0].acknowledged);
  EXPECT_FALSE(shown[1].acknowledged) << "nobody has seen that one";
}

TEST(Board, TellsOfWhatGotWorseOrCameAgain) {
  Board board;
  Condition few = kFew;
  few.degree = 2;
  board.take({few}, 100);
  ASSERT_TRUE(board.acknowledge(few.id));
  few.degree = 3;
  EXPECT_FALSE(board.shown({few}, 101)[0].acknowledged);
  board.take({few}, 101);
  few.degree = 2;
  EXPECT_FALSE(board.shown({few}, 102)[0].acknowledged) << "it was worse meanwhile";
  ASSERT_TRUE(board.acknowledge(few.id));
  few.severity = Severity::Bad;
  EXPECT_FALSE(board.shown({few}, 103)[0].acknowledged);

  board.take({kSilent}, 104);
  ASSERT_TRUE(board.acknowledge(kSilent.id));
  board.take({}, 105);
  EXPECT_FALSE(board.shown({kSilent}, 106)[0].acknowledged) << "it came again";
}

TEST(Board, AcknowledgesNothingThatIsNotThere) {
  Board board;
  EXPECT_FALSE(board.acknowledge("robot_silent:uav5"));
}

TEST(Words, SayAgesAndThePast) {
  EXPECT_EQ(age_text(59.9), "59 s");
  EXPECT_EQ(age_text(-1), "0 s");
  EXPECT_EQ(age_text(720), "12 min");
  EXPECT_EQ(age_text(7500), "2:05 h");
  EXPECT_EQ(clock_text(94), "1:34");
  EXPECT_EQ(past("uav5 is silent"), "uav5 was silent");
  EXPECT_EQ(past("All 20 robots are silent"), "All 20 robots were silent");
  EXPECT_EQ(past("What answers is no Command Post"), "What answers was no Command Post");
}

}  // namespace
}  // namespace adit::alarms
