#include "alarms/board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "alarms/alarm.hpp"
#include "alarms/alike.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

const Condition kSilent{
    .id = "robot_silent:uav5", .side = Side::Robot, .since = 70, .headline = {"uav5", "silent"}};
const Condition kHeld{
    .id = "report_held:7", .severity = Severity::Ask, .since = 50, .headline = {"Report 7", "held"}};
const Condition kFew{
    .id = "reports_left", .severity = Severity::Wait, .headline = {"5 reports", "left", true}};

auto id_is(const char* id) {
  return Field(&Alarm::id, id);
}

TEST(Board, SortsBySeverityThenByAge) {
  Condition older = kSilent;
  older.id = "robot_silent:uav4";
  older.since = 60;
  EXPECT_THAT(Board().to_alarms({kFew, kHeld, kSilent, older}, 100),
              ElementsAre(id_is("robot_silent:uav4"), id_is("robot_silent:uav5"), id_is("report_held:7"),
                          id_is("reports_left")));
}

TEST(Board, RecordsTheStartOfAnAlarm) {
  Board board;
  board.update({kFew, kSilent}, 100);
  const auto shown = board.to_alarms({kFew, kSilent}, 160);
  EXPECT_EQ(shown[0].since, 70) << "the rules' time";
  EXPECT_EQ(shown[1].since, 100) << "the time at which it was found";
}

TEST(Board, RestartsAnAlarmOfAnotherSeverity) {
  Board board;
  board.update({kFew}, 100);
  Condition none = kFew;
  none.severity = Severity::Bad;
  none.headline = {"No reports", "left", true};
  board.update({none}, 160);
  EXPECT_EQ(board.to_alarms({none}, 164)[0].since, 160) << "few were left since 100, none since 160";
}

TEST(Board, TellsForHowLongAnEndedAlarmWasAtItsWorst) {
  Board board;
  Condition doubt{.id = "report_in_doubt:7", .severity = Severity::Ask, .headline = {"Report 7", "in doubt"}};
  board.update({doubt}, 100);
  doubt.severity = Severity::Wait;
  board.update({doubt}, 160);
  board.update({}, 162);
  EXPECT_EQ(board.ended_alarms().front().severity, Severity::Ask);
  EXPECT_EQ(board.ended_alarms().front().since, 100) << "the operator was asked since then";
  doubt.severity = Severity::Wait;
  board.update({doubt}, 200);
  doubt.severity = Severity::Ask;
  board.update({doubt}, 215);
  board.update({}, 230);
  EXPECT_EQ(board.ended_alarms().front().since, 215);
}

TEST(Board, RemembersTheLastEndedAlarms) {
  Board board;
  board.update({kSilent}, 100);
  board.update({}, 111);
  EXPECT_THAT(board.ended_alarms(), ElementsAre(EndedAlarm{.id = "robot_silent:uav5",
                                                           .severity = Severity::Bad,
                                                           .side = Side::Robot,
                                                           .was = "uav5 was silent",
                                                           .since = 70,
                                                           .until = 111}));
  for (int i = 0; i < 50; ++i) {
    board.update({kHeld}, 200 + 2 * i);
    board.update({}, 201 + 2 * i);
  }
  EXPECT_EQ(board.ended_alarms().size(), Board::kMostOver);
  EXPECT_EQ(board.ended_alarms().front().until, 299) << "the newest first";
}

TEST(Board, RemembersAnAlarmAtItsWorst) {
  Board board;
  for (const std::uint64_t count : {7u, 20u, 7u}) {
    board.update({{.id = "robots_silent",
                   .headline = {icd::sentence(count, " robots"), "silent", true},
                   .degree = count}},
                 100);
  }
  board.update({}, 111);
  EXPECT_EQ(board.ended_alarms().front().was, "20 robots were silent");
}

TEST(Board, AcknowledgedAlarmStaysQuietWhileUnchanged) {
  Board board;
  board.update({kSilent, kHeld}, 100);
  ASSERT_TRUE(board.acknowledge(kSilent.id, 100));
  board.update({kSilent, kHeld}, 101);
  const auto shown = board.to_alarms({kSilent, kHeld}, 102);
  EXPECT_TRUE(shown[0].acknowledged);
  EXPECT_FALSE(shown[1].acknowledged) << "this alarm was never acknowledged";
}

/// A board on which the condition was acknowledged at 100.
Board acknowledged_on(const Condition& seen) {
  Board board;
  board.update({seen}, 90);
  EXPECT_TRUE(board.acknowledge(seen.id, 100));
  return board;
}

TEST(Board, AcknowledgedAlarmReturnsIfWorseOrRepeated) {
  Condition few = kFew;
  few.degree = 2;
  Board board = acknowledged_on(few);
  few.degree = 3;
  EXPECT_FALSE(board.to_alarms({few}, 101)[0].acknowledged);
  board.update({few}, 101);
  few.degree = 2;
  EXPECT_FALSE(board.to_alarms({few}, 102)[0].acknowledged) << "the alarm was worse meanwhile";
  ASSERT_TRUE(board.acknowledge(few.id, 100));
  few.severity = Severity::Bad;
  EXPECT_FALSE(board.to_alarms({few}, 103)[0].acknowledged);

  board.update({kSilent}, 104);
  ASSERT_TRUE(board.acknowledge(kSilent.id, 100));
  board.update({}, 105);
  EXPECT_FALSE(board.to_alarms({kSilent}, 106)[0].acknowledged) << "the alarm is a new one";
}

TEST(Board, ComparesWithTheLowestDegreeSinceAcknowledgement) {
  Condition few = kFew;
  few.degree = 5;
  Board board = acknowledged_on(few);
  few.degree = 1;
  board.update({few}, 101);
  EXPECT_TRUE(board.to_alarms({few}, 101)[0].acknowledged) << "a smaller alarm stays acknowledged";
  few.degree = 5;
  EXPECT_FALSE(board.to_alarms({few}, 102)[0].acknowledged) << "four of the reports were not acknowledged";
}

TEST(Board, RejectsAcknowledgementOfAnAbsentAlarm) {
  Board board;
  EXPECT_FALSE(board.acknowledge("robot_silent:uav5", 100));
}

/// A board that starts at `now`, after a board on which the condition was acknowledged at 100.
Board after_a_restart(const Condition& seen, double now) {
  const Board before = acknowledged_on(seen);
  Board after;
  const auto kept = read_acknowledged(write_acknowledged(before.acknowledgements()));
  EXPECT_TRUE(kept) << kept.error();
  after.remember(*kept, now);
  return after;
}

/// Whether the board shows the condition as acknowledged.
bool is_quiet(Board& board, const Condition& condition, double now) {
  board.update({condition}, now);
  return board.to_alarms({condition}, now).front().acknowledged;
}

TEST(Board, AcknowledgementSurvivesARestart) {
  Board board = after_a_restart(kHeld, 130);
  board.update({}, 131);
  EXPECT_EQ(board.acknowledgements().size(), 1u) << "the condition may be found again after some seconds";
  EXPECT_TRUE(is_quiet(board, kHeld, 140));
  EXPECT_TRUE(is_quiet(board, kHeld, 5000)) << "the condition continues";
  ASSERT_EQ(board.acknowledgements().size(), 1u);
  EXPECT_EQ(board.acknowledgements().front().at, 100) << "a restart keeps the time";
  board.update({}, 5001);
  EXPECT_THAT(board.acknowledgements(), IsEmpty());
  EXPECT_FALSE(is_quiet(board, kHeld, 5002)) << "the alarm is a new one";
}

TEST(Board, OldAcknowledgementHidesNoNewAlarm) {
  Condition few = kFew;
  few.degree = 2;
  Condition worse = few, bad = few, otherwise = few, another = few;
  worse.degree = 3;
  bad.severity = Severity::Bad;
  otherwise.why = "of another run";
  another.id = "report_held:8";
  for (const Condition& each : {worse, bad, otherwise, another}) {
    Board board = after_a_restart(few, 130);
    EXPECT_FALSE(is_quiet(board, each, 131)) << each.id << each.headline.now() << each.why;
  }
  Board late = after_a_restart(few, 130);
  EXPECT_FALSE(is_quiet(late, few, 131 + Acknowledgement::kWaitsFor))
      << "the condition is found a minute after the start";
  Board old = after_a_restart(few, 101 + Acknowledgement::kHolds);
  EXPECT_FALSE(is_quiet(old, few, 102 + Acknowledgement::kHolds)) << "the box was off too long";
  Board early = after_a_restart(few, 99);
  EXPECT_FALSE(is_quiet(early, few, 99)) << "the clock went back";
  Board was_worse = after_a_restart(few, 130);
  was_worse.update({worse}, 131);
  EXPECT_FALSE(is_quiet(was_worse, few, 132)) << "the alarm was worse meanwhile";
  Board went = after_a_restart(few, 130);
  went.update({otherwise}, 131);
  went.update({}, 132);
  EXPECT_FALSE(is_quiet(went, few, 133)) << "the alarm is a new one";
}

TEST(Board, AcknowledgementWaitsForTheSameAlarmAfterARestart) {
  Condition both{.id = "command_post_unreachable", .headline = {"Command Post", "unreachable"}, .degree = 2};
  Condition one = both;
  one.headline.subject = "Scoring";
  one.degree = 1;
  Board board = after_a_restart(both, 130);
  EXPECT_FALSE(is_quiet(board, one, 133));
  EXPECT_TRUE(is_quiet(board, both, 134));
}

TEST(Acknowledged, AreBounded) {
  Board board;
  std::vector<Condition> many;
  for (int i = 0; i < 100; ++i)
    many.push_back({.id = "report_held:" + std::to_string(i), .headline = {"It", "held"}});
  many[7].why = std::string(5000, 'x');
  board.update(many, 90);
  for (const Condition& each : many) ASSERT_TRUE(board.acknowledge(each.id, 100));
  EXPECT_EQ(board.acknowledgements().size(), Acknowledgement::kMost);
  EXPECT_LT(write_acknowledged(board.acknowledgements()).size(), 100'000u);
}

TEST(Acknowledged, RejectATruncatedFile) {
  const std::string good = write_acknowledged(
      {{.id = "messages_rejected", .severity = Severity::Ask, .degree = 2, .what = "2 are", .at = 7}});
  ASSERT_EQ(read_acknowledged(good).value().front().degree, 2u);
  for (std::size_t at = 0; at + 2 < good.size(); ++at) EXPECT_FALSE(read_acknowledged(good.substr(0, at)));
  EXPECT_EQ(read_acknowledged(R"({"version":2,"acknowledged":[]})").error(), "version: expected 1");
  EXPECT_FALSE(read_acknowledged(R"({"version":1,"acknowledged":[{"id":7}]})"));
}

TEST(Words, ShowAgesAndPastForms) {
  EXPECT_EQ(age_text(59.9), "59 s");
  EXPECT_EQ(age_text(-1), "0 s");
  EXPECT_EQ(age_text(720), "12 min");
  EXPECT_EQ(age_text(7500), "2:05 h");
  EXPECT_EQ(clock_text(94), "1:34");
  EXPECT_EQ((Headline{"uav5", "silent"}.now()), "uav5 is silent");
  EXPECT_EQ((Headline{"What is lit", "wrong"}.past()), "What is lit was wrong")
      << "a subject may contain verbs";
  EXPECT_EQ((Headline{"All 20 robots", "silent", true}.past()), "All 20 robots were silent");
}

TEST(Board, DurationsSurviveAClockStep) {
  Board board;
  board.update({kHeld, kFew}, 100);
  board.update({kFew}, 110);
  board.move(3600);
  EXPECT_EQ(board.to_alarms({kFew}, 3720)[0].since, 3700);
  EXPECT_EQ(board.ended_alarms().front().since, 3650);
  EXPECT_EQ(board.ended_alarms().front().until, 3710);
}

}  // namespace
}  // namespace adit::alarms
