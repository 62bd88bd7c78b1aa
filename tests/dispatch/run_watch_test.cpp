#include "dispatch/run_watch.hpp"

#include <gmock/gmock.h>

namespace adit::dispatch {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string why(const std::optional<AnotherRun>& another) {
  return another ? another->why : "";
}

/// Both clocks run and show `clock`.
Run run_at(double clock) {
  return {.id = "1",
          .last = icd::RunStatus{3, clock, 14, "subt"},
          .status_clock = Clock{clock, true},
          .answer_clock = Clock{clock, true}};
}
Run nameless_run_at(double clock) {
  Run run = run_at(clock);
  run.id.clear();
  return run;
}
std::string another(double before, double clock, double silence) {
  return why(another_run(run_at(before), icd::RunStatus{3, clock, 14, "subt"}, silence));
}

icd::ReportReply reply(const std::string& run, double run_clock) {
  icd::ReportReply reply;
  reply.run = run;
  reply.run_clock = run_clock;
  return reply;
}

TEST(RunClock, RunsIfItAdvancedOnce) {
  const Clock first = seen_again(std::nullopt, 5);
  EXPECT_EQ(first, (Clock{5, false}));
  EXPECT_EQ(seen_again(first, 5), (Clock{5, false})) << "it stands";
  EXPECT_EQ(seen_again(first, 3), (Clock{3, false})) << "it went back";
  EXPECT_EQ(seen_again(first, 6), (Clock{6, true}));
  EXPECT_EQ(seen_again(Clock{6, true}, 6), (Clock{6, true})) << "it stands in a stop";
}

TEST(RunChange, ShowsByAClockThatGoesBack) {
  EXPECT_THAT(another(600, 2, 10), HasSubstr("went back from 600 s to 2 s"));
  EXPECT_THAT(another(600, 598.9, 1), HasSubstr("went back"));
  EXPECT_THAT(another(600, 599.1, 1), IsEmpty()) << "less than a second";
}

TEST(RunChange, IsUncertainIfOnlyAClockShowsIt) {
  EXPECT_FALSE(another_run(run_at(600), icd::RunStatus{3, 2, 14, "subt"}, 1)->certain);
  EXPECT_FALSE(another_run(nameless_run_at(600), reply("1", 2), 1)->certain);
  EXPECT_FALSE(another_run(run_at(600), icd::RunStatus{3, 620, 14, "subt"}, 3000)->certain);
  EXPECT_TRUE(another_run(run_at(600), icd::RunStatus{3, 610, 14, "other"}, 10)->certain);
  EXPECT_TRUE(another_run(run_at(600), icd::RunStatus{3, 2, 15, "subt"}, 10)->certain);
  EXPECT_TRUE(another_run(run_at(600), reply("2", 601), 10)->certain);
}

/// Both for the status and for answers.
TEST(RunChange, DoesNotShowByAClockThatStands) {
  struct Case {
    double shown, shows, silence;
  };
  for (const auto& [shown, shows, silence] :
       {Case{25.98, 3.14, 1}, Case{25.98, 25.98, 3600}, Case{3.14, 3.14, 1e6}, Case{600, 2, 5}}) {
    dispatch::Run run = nameless_run_at(shown);
    run.status_clock->runs = run.answer_clock->runs = false;
    EXPECT_THAT(why(another_run(run, icd::RunStatus{3, shows, 14, "subt"}, silence)), IsEmpty()) << shown;
    EXPECT_THAT(why(another_run(run, reply("", shows), silence)), IsEmpty()) << shown;
  }
}

TEST(RunChange, ShowsByTheClockOfEachUri) {
  dispatch::Run run = nameless_run_at(600);
  run.answer_clock = std::nullopt;
  EXPECT_THAT(why(another_run(run, reply("", 3.14), 1)), IsEmpty()) << "first answer";
  run.answer_clock = Clock{3.14, false};
  EXPECT_THAT(why(another_run(run, reply("", 3.14), 3600)), IsEmpty());
  EXPECT_THAT(why(another_run(run, icd::RunStatus{3, 601, 14, "subt"}, 1)), IsEmpty());
}

TEST(RunChange, ShowsByAnotherTeam) {
  const icd::RunStatus status{3, 610, 14, "other"};
  EXPECT_EQ(why(another_run(run_at(600), status, 10)), "the team is \"other\", it was \"subt\"");
}

TEST(RunChange, ShowsByMoreReportsLeft) {
  const auto left = [](const dispatch::Run& run, std::int64_t reports) {
    return why(another_run(run, icd::RunStatus{0, run.last->run_clock, reports, "subt"}, 10));
  };
  EXPECT_EQ(left(run_at(600), 15), "the reports left went up from 14 to 15");
  EXPECT_THAT(left(run_at(600), 14), IsEmpty());
  EXPECT_THAT(left(run_at(600), 3), IsEmpty());
  EXPECT_THAT(left(run_at(0), 25), IsEmpty()) << "any count before the start";
  dispatch::Run standing = run_at(0);
  standing.answer_clock = Clock{3.14, false};
  EXPECT_THAT(left(standing, 15), HasSubstr("went up")) << "the answers show that it has started";
}

TEST(RunChange, ShowsByAClockThatDoesNotFitASilence) {
  EXPECT_THAT(another(600, 620, 3000), HasSubstr("after 3000 s of silence"));
  EXPECT_THAT(another(600, 3590, 3000), IsEmpty());
  EXPECT_THAT(another(600, 610, 29), IsEmpty()) << "too short a silence";
}

TEST(RunChange, IsNotTheStartOfARun) {
  EXPECT_THAT(another(0, 0, 3000), IsEmpty());
  EXPECT_THAT(another(0, 5, 3000), IsEmpty());
}

TEST(RunChange, IsNotTheFirstStatus) {
  EXPECT_THAT(why(another_run(dispatch::Run{}, icd::RunStatus{3, 5, 14, "subt"}, 1e9)), IsEmpty());
  EXPECT_THAT(why(another_run(dispatch::Run{}, reply("7", 5), 1e9)), IsEmpty());
}

TEST(RunChange, ShowsByTheRunOfAnAnswer) {
  EXPECT_EQ(why(another_run(run_at(600), reply("2", 601), 1)),
            "the Command Post calls it run \"2\", it was \"1\"");
  EXPECT_THAT(why(another_run(run_at(600), reply("1", 601), 1)), IsEmpty());
  EXPECT_THAT(why(another_run(run_at(600), reply("1", 4), 1)), IsEmpty()) << "the name decides";
}

TEST(RunChange, ShowsByTheClockOfAnAnswer) {
  EXPECT_THAT(why(another_run(nameless_run_at(600), reply("1", 4), 1)), HasSubstr("went back"));
  EXPECT_THAT(why(another_run(run_at(600), reply("", 4), 1)), HasSubstr("went back"));
  EXPECT_THAT(why(another_run(run_at(600), reply("", 0), 1)), IsEmpty());
}

/// The map if this status follows run_at(600).
NextMap map_after(const icd::RunStatus& status, const std::string& id = "", std::int64_t may_be = 0) {
  Run before = run_at(600), now{.number = 2, .id = id, .began = 70, .last = status, .may_be = may_be};
  before.heard = 60;
  return next_map(before, now);
}

TEST(NextMap, IsEmptyInACertainNewRun) {
  EXPECT_EQ(map_after({3, 601, 14, "other"}), NextMap::Empty);
  EXPECT_EQ(map_after({3, 601, 14, "other"}, "1"), NextMap::Empty) << "each team has a run 1";
  EXPECT_EQ(map_after({3, 601, 14, "subt"}, "2"), NextMap::Empty);
  EXPECT_EQ(map_after({0, 2, 25, "subt"}), NextMap::Empty);
}

TEST(NextMap, MayBeTheSameIfOnlyAClockShowsANewRun) {
  EXPECT_EQ(map_after({3, 540, 14, "subt"}, "", 1), NextMap::MayBeTheSame);
  EXPECT_EQ(map_after({3, 605, 14, "subt"}, "", 1), NextMap::MayBeTheSame);
  EXPECT_EQ(map_after({3, 540, 14, "subt"}, "1", 1), NextMap::MayBeTheSame);
  EXPECT_EQ(map_after({3, 540, 14, "subt"}, "2", 1), NextMap::Empty) << "the name decides";
}

TEST(NextMap, MayBeTheSameIfOnlyMoreReportsAreLeft) {
  EXPECT_EQ(map_after({3, 601, 15, "subt"}), NextMap::MayBeTheSame) << "a report may have been granted";
  EXPECT_EQ(map_after({3, 599.5, 15, "subt"}), NextMap::MayBeTheSame) << "jitter";
}

TEST(NextMap, IsEmptyIfTheOperatorDeclaresARun) {
  dispatch::Run before = run_at(600);
  before.heard = 60;
  EXPECT_EQ(next_map(before, {.number = 2, .began = 70}), NextMap::Empty);
}

TEST(NextMap, IsTheEarlierOneInAResumedRun) {
  dispatch::Run before = run_at(600), now = run_at(300);
  before.heard = 80;
  now.last->current_team = "other";
  now.began = 70;
  EXPECT_EQ(next_map(before, now), NextMap::Earlier);
}

TEST(RunWatch, NeedsAStatusClockThatRan) {
  dispatch::Run run = run_at(600);
  EXPECT_TRUE(tells_of_another(run));
  run.status_clock->runs = false;
  EXPECT_FALSE(tells_of_another(run)) << "although the answers' clock runs";
  EXPECT_FALSE(tells_of_another({}));
}

}  // namespace
}  // namespace adit::dispatch
