#include "dispatch/run_watch.hpp"

#include <gmock/gmock.h>

namespace adit::dispatch {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

Run run_at(double clock) {
  return {.id = "1", .last = icd::RunStatus{3, clock, 14, "subt"}};
}
std::string another(double before, double clock, double silence) {
  return another_run(run_at(before), icd::RunStatus{3, clock, 14, "subt"}, silence);
}

icd::ReportReply reply(const std::string& run, double run_clock) {
  icd::ReportReply reply;
  reply.run = run;
  reply.run_clock = run_clock;
  return reply;
}

TEST(AnotherRun, ShowsByAClockThatRanBackward) {
  EXPECT_THAT(another(600, 2, 10), HasSubstr("went back from 600 s to 2 s"));
  EXPECT_THAT(another(600, 598.9, 1), HasSubstr("went back"));
  EXPECT_THAT(another(600, 599.1, 1), IsEmpty()) << "a jitter of less than a second";
}

TEST(AnotherRun, ShowsByAnotherTeam) {
  const icd::RunStatus status{3, 610, 14, "other"};
  EXPECT_EQ(another_run(run_at(600), status, 10), "the team is \"other\", it was \"subt\"");
}

TEST(AnotherRun, ShowsAfterALongSilenceByAClockThatDoesNotFitIt) {
  EXPECT_THAT(another(600, 620, 3000), HasSubstr("after 3000 s without word"));
  EXPECT_THAT(another(600, 3590, 3000), IsEmpty());
  EXPECT_THAT(another(600, 610, 29), IsEmpty()) << "a silence too short for that";
}

TEST(AnotherRun, IsNotTheStartOfTheOneThatWasWaitedFor) {
  EXPECT_THAT(another(0, 0, 3000), IsEmpty());
  EXPECT_THAT(another(0, 5, 3000), IsEmpty());
}

TEST(AnotherRun, IsNeverTheFirstThatIsHeardOf) {
  EXPECT_THAT(another_run(dispatch::Run{}, icd::RunStatus{3, 5, 14, "subt"}, 1e9), IsEmpty());
  EXPECT_THAT(another_run(dispatch::Run{}, reply("7", 5), 1e9), IsEmpty());
}

TEST(AnotherRun, ShowsByTheRunOfAnAnswer) {
  EXPECT_EQ(another_run(run_at(600), reply("2", 601), 1),
            "the Command Post calls it run \"2\", it was \"1\"");
  EXPECT_THAT(another_run(run_at(600), reply("1", 601), 1), IsEmpty());
}

TEST(AnotherRun, ShowsByTheClockOfAnAnswerThatHasOne) {
  EXPECT_THAT(another_run(run_at(600), reply("1", 4), 1), HasSubstr("went back"));
  EXPECT_THAT(another_run(run_at(600), reply("1", 0), 1), IsEmpty());
  EXPECT_THAT(another_run(run_at(600), reply("", 0), 1), IsEmpty());
}

}  // namespace
}  // namespace adit::dispatch
