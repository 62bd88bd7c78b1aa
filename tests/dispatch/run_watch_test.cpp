#include <gmock/gmock.h>

#include "dispatch/runs.hpp"

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
/// The last status of the run is as old as its last clock.
Silence silent(double seconds) {
  return {seconds, seconds};
}
std::string another(double before, double clock, double silence) {
  return why(another_run(run_at(before), icd::RunStatus{3, clock, 14, "subt"}, silent(silence)));
}

icd::ReportReply reply(const std::string& run, double run_clock) {
  icd::ReportReply reply;
  reply.run = run;
  reply.run_clock = run_clock;
  return reply;
}

TEST(RunClock, RunsIfItAdvancedOnce) {
  const Clock first = update_clock(std::nullopt, 5);
  EXPECT_EQ(first, (Clock{5, false}));
  EXPECT_EQ(update_clock(first, 5), (Clock{5, false})) << "it stands";
  EXPECT_EQ(update_clock(first, 3), (Clock{3, false})) << "it went back";
  EXPECT_EQ(update_clock(first, 6), (Clock{6, true}));
  EXPECT_EQ(update_clock(Clock{6, true}, 6), (Clock{6, true})) << "it stands in a stop";
}

TEST(RunChange, ShowsByAClockThatGoesBack) {
  EXPECT_THAT(another(600, 2, 10), HasSubstr("went back from 600 s to 2 s"));
  EXPECT_THAT(another(600, 598.9, 1), HasSubstr("went back"));
  EXPECT_THAT(another(600, 599.1, 1), IsEmpty()) << "less than a second";
}

/// Signs of a status 10 s after a run with clock 600, score 3 and 14 reports left; "": no other run.
std::string signs_of(double clock, std::int64_t left, std::int64_t score, double silence = 10) {
  const auto another = another_run(run_at(600), icd::RunStatus{score, clock, left, "subt"}, silent(silence));
  if (!another) return "";
  std::string signs;
  if (another->signs.count) signs += "count ";
  if (another->signs.clock) signs += "clock ";
  if (another->signs.score) signs += "score ";
  return signs + (another->signs.agree() ? "agree" : "one");
}
bool is_granted(double clock, std::int64_t left, std::int64_t score, double silence = 10) {
  return is_grant(run_at(600), icd::RunStatus{score, clock, left, "subt"}, silent(silence));
}

TEST(RunSigns, AreNoneIfTheClockGoesOnAsTimePassed) {
  EXPECT_EQ(signs_of(610, 14, 3), "");
  EXPECT_EQ(signs_of(610, 13, 4), "");
  EXPECT_EQ(signs_of(610, 15, 3), "") << "a grant";
  EXPECT_EQ(signs_of(610, 14, 2), "") << "a corrected score";
}

TEST(RunSigns, AreOneIfTheCountRisesWhileTheClockShowsNothing) {
  EXPECT_EQ(signs_of(600, 15, 3), "count one") << "it stands";
  EXPECT_EQ(signs_of(604, 15, 3), "count one") << "it stood";
  EXPECT_EQ(signs_of(615, 15, 3), "count one") << "it is ahead";
  EXPECT_EQ(signs_of(631, 15, 3, 31), "count one") << "too long a silence";
  EXPECT_EQ(signs_of(600, 14, 2), "score one") << "it stands";
}

TEST(RunSigns, AreOneIfOnlyTheClockGoesBackOrFallsBehind) {
  EXPECT_EQ(signs_of(2, 14, 3), "clock one");
  EXPECT_EQ(signs_of(610, 14, 3, 40), "clock one");
}

TEST(RunSigns, AgreeIfTwoChange) {
  EXPECT_EQ(signs_of(2, 25, 3), "count clock agree");
  EXPECT_EQ(signs_of(2, 25, 0), "count clock score agree");
  EXPECT_EQ(signs_of(2, 14, 0), "clock score agree");
  EXPECT_EQ(signs_of(610, 25, 0), "count score agree") << "although the clock goes on";
  EXPECT_EQ(signs_of(600, 25, 0), "count score agree") << "the clock stands";
  EXPECT_EQ(signs_of(610, 15, 3, 40), "count clock agree") << "the clock fell behind";
}

TEST(RunSigns, AgreeAlthoughTheClockWasNotSeenToRun) {
  dispatch::Run run = run_at(600);
  run.status_clock->runs = false;
  EXPECT_EQ(why(another_run(run, icd::RunStatus{3, 2, 14, "subt"}, silent(10))), "") << "the clock alone";
  EXPECT_EQ(another_run(run, icd::RunStatus{3, 2, 15, "subt"}, silent(10))->signs,
            (Signs{.count = true, .clock = true}));
}

TEST(RunSigns, AreNoneBeforeTheStart) {
  dispatch::Run before = run_at(0);
  before.answer_clock = std::nullopt;
  EXPECT_EQ(why(another_run(before, icd::RunStatus{0, 0, 25, "subt"}, silent(10))), "");
}

TEST(RunSigns, NameTheirReasons) {
  EXPECT_EQ(why(another_run(run_at(600), icd::RunStatus{0, 2, 25, "subt"}, silent(10))),
            "the run clock went back from 600 s to 2 s and the score fell from 3 to 0 and the reports left "
            "went up from 14 to 25");
}

TEST(Grant, IsACountThatRisesInARunThatGoesOn) {
  EXPECT_TRUE(is_granted(610, 15, 3));
  EXPECT_TRUE(is_granted(610.9, 20, 4)) << "and reports were scored";
  EXPECT_TRUE(is_granted(609.1, 15, 3));
  EXPECT_TRUE(is_granted(630, 15, 3, 30));
}

TEST(Grant, IsNoneWithoutARise) {
  EXPECT_FALSE(is_granted(610, 14, 3));
  EXPECT_FALSE(is_granted(610, 3, 3));
}

TEST(Grant, IsNoneIfTheScoreFalls) {
  EXPECT_FALSE(is_granted(610, 15, 2));
}

TEST(Grant, IsNoneIfTheClockDoesNotGoOn) {
  EXPECT_FALSE(is_granted(600, 15, 3)) << "it stands";
  EXPECT_FALSE(is_granted(600, 15, 3, 0.5)) << "it stands, for less than its jitter";
  EXPECT_FALSE(is_granted(608.9, 15, 3)) << "behind";
  EXPECT_FALSE(is_granted(611.1, 15, 3)) << "ahead";
  EXPECT_FALSE(is_granted(2, 15, 3)) << "back";
}

TEST(Grant, IsNoneIfAnotherRunCouldShowThatClock) {
  EXPECT_FALSE(is_granted(631, 15, 3, 31)) << "a silence over 30 s";
  const dispatch::Run young = run_at(0.5);
  EXPECT_FALSE(is_grant(young, icd::RunStatus{3, 10.5, 15, "subt"}, silent(10)));
  const Silence since_a_restart{.at_least = 10};
  EXPECT_FALSE(is_grant(run_at(600), icd::RunStatus{3, 610, 15, "subt"}, since_a_restart));
}

TEST(Grant, NeedsNoClockThatWasSeenToRun) {
  dispatch::Run run = run_at(600);
  run.status_clock->runs = false;
  EXPECT_TRUE(is_grant(run, icd::RunStatus{3, 610, 15, "subt"}, silent(10))) << "now it runs";
}

NameCheck checked(double clock, std::int64_t left, std::int64_t score, const Silence& silence = silent(10)) {
  return check_name(run_at(600), icd::RunStatus{score, clock, left, "subt"}, silence);
}

TEST(AnotherName, IsConfirmedByAnySign) {
  EXPECT_EQ(checked(2, 13, 3), NameCheck::Confirmed) << "clock";
  EXPECT_EQ(checked(604, 15, 3), NameCheck::Confirmed) << "count";
  EXPECT_EQ(checked(604, 13, 2), NameCheck::Confirmed) << "score";
  EXPECT_EQ(check_name(run_at(600), {3, 610, 13, "other"}, silent(10)), NameCheck::Confirmed) << "team";
}

TEST(AnotherName, IsConfirmedIfARunThatBeganSinceMayShowTheClock) {
  EXPECT_EQ(checked(1300, 13, 3, silent(1300)), NameCheck::Confirmed);
  EXPECT_EQ(checked(1302, 13, 3, silent(1300)), NameCheck::Contradicted);
}

TEST(AnotherName, IsContradictedIfCountAndClockGoOn) {
  EXPECT_EQ(checked(610, 13, 3), NameCheck::Contradicted);
  EXPECT_EQ(checked(610, 14, 3), NameCheck::Contradicted) << "the count may be late";
  EXPECT_EQ(checked(605, 13, 4), NameCheck::Contradicted) << "it stood";
}

TEST(AnotherName, IsUncertainAfterARestart) {
  EXPECT_EQ(checked(1300, 13, 3, {.at_least = 1200}), NameCheck::Unknown) << "the silence may be longer";
  EXPECT_EQ(checked(1300, 13, 3, {.at_least = 1100}), NameCheck::Contradicted);
}

TEST(AnotherName, IsCheckedByTheCountIfTheClockStands) {
  dispatch::Run run = run_at(26);
  run.status_clock->runs = false;
  EXPECT_EQ(check_name(run, {3, 26, 13, "subt"}, silent(10)), NameCheck::Contradicted);
  EXPECT_EQ(check_name(run, {3, 26, 14, "subt"}, silent(10)), NameCheck::Unknown);
  EXPECT_EQ(check_name(run, {3, 26, 24, "subt"}, silent(10)), NameCheck::Confirmed);
}

TEST(RunChange, IsCertainOnlyByTheTeam) {
  EXPECT_FALSE(another_run(run_at(600), icd::RunStatus{3, 610, 14, "other"}, silent(10))->signs.is_any());
  EXPECT_EQ(another_run(run_at(600), reply("2", 601), silent(10))->signs, Signs{.name = true});
  EXPECT_EQ(another_run(nameless_run_at(600), reply("1", 2), silent(1))->signs, Signs{.clock = true});
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
    EXPECT_THAT(why(another_run(run, icd::RunStatus{3, shows, 14, "subt"}, silent(silence))), IsEmpty())
        << shown;
    EXPECT_THAT(why(another_run(run, reply("", shows), silent(silence))), IsEmpty()) << shown;
  }
}

TEST(RunChange, ShowsByTheClockOfEachUri) {
  dispatch::Run run = nameless_run_at(600);
  run.answer_clock = std::nullopt;
  EXPECT_THAT(why(another_run(run, reply("", 3.14), silent(1))), IsEmpty()) << "first answer";
  run.answer_clock = Clock{3.14, false};
  EXPECT_THAT(why(another_run(run, reply("", 3.14), silent(3600))), IsEmpty());
  EXPECT_THAT(why(another_run(run, icd::RunStatus{3, 601, 14, "subt"}, silent(1))), IsEmpty());
}

TEST(RunChange, ShowsByAnotherTeam) {
  const icd::RunStatus status{3, 610, 14, "other"};
  EXPECT_EQ(why(another_run(run_at(600), status, silent(10))), "the team is \"other\", it was \"subt\"");
}

TEST(RunChange, ShowsByMoreReportsLeft) {
  const auto left = [](const dispatch::Run& run, std::int64_t reports) {
    return why(another_run(run, icd::RunStatus{3, run.last->run_clock, reports, "subt"}, silent(10)));
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
  EXPECT_THAT(why(another_run(dispatch::Run{}, icd::RunStatus{3, 5, 14, "subt"}, silent(1e9))), IsEmpty());
  EXPECT_THAT(why(another_run(dispatch::Run{}, reply("7", 5), silent(1e9))), IsEmpty());
}

TEST(RunChange, ShowsByTheRunOfAnAnswer) {
  EXPECT_EQ(why(another_run(run_at(600), reply("2", 601), silent(1))),
            "the Command Post calls it run \"2\", it was \"1\"");
  EXPECT_THAT(why(another_run(run_at(600), reply("1", 601), silent(1))), IsEmpty());
  EXPECT_THAT(why(another_run(run_at(600), reply("1", 4), silent(1))), IsEmpty()) << "the name decides";
}

TEST(RunChange, ShowsByTheClockOfAnAnswer) {
  EXPECT_THAT(why(another_run(nameless_run_at(600), reply("1", 4), silent(1))), HasSubstr("went back"));
  EXPECT_THAT(why(another_run(run_at(600), reply("", 4), silent(1))), HasSubstr("went back"));
  EXPECT_THAT(why(another_run(run_at(600), reply("", 0), silent(1))), IsEmpty());
}

/// The map if this status follows run_at(600).
NextMap map_after(const icd::RunStatus& status, const std::string& id = "", const Signs& signs = {}) {
  Run before = run_at(600),
      now{.number = 2, .id = id, .began = 70, .last = status, .may_be = signs.is_any(), .signs = signs};
  before.heard = 60;
  return next_map(before, now);
}

TEST(NextMap, IsEmptyInACertainNewRun) {
  EXPECT_EQ(map_after({3, 601, 14, "other"}), NextMap::Empty);
  EXPECT_EQ(map_after({3, 601, 14, "other"}, "1"), NextMap::Empty) << "each team has a run 1";
  EXPECT_EQ(map_after({3, 601, 14, "subt"}, "2"), NextMap::Empty);
  EXPECT_EQ(map_after({0, 2, 25, "subt"}), NextMap::Empty);
}

TEST(NextMap, IsEmptyIfCountAndClockShowANewRun) {
  const Signs signs{.count = true, .clock = true};
  EXPECT_EQ(map_after({0, 2, 25, "subt"}, "", signs), NextMap::Empty);
  EXPECT_EQ(map_after({0, 605, 25, "subt"}, "", signs), NextMap::MayBeTheSame) << "it only fell behind";
}

TEST(NextMap, MayBeTheSameIfOneSignShowsANewRun) {
  EXPECT_EQ(map_after({3, 540, 14, "subt"}, "", {.clock = true}), NextMap::MayBeTheSame);
  EXPECT_EQ(map_after({3, 605, 14, "subt"}, "", {.clock = true}), NextMap::MayBeTheSame);
  EXPECT_EQ(map_after({3, 540, 14, "subt"}, "1", {.clock = true}), NextMap::MayBeTheSame);
  EXPECT_EQ(map_after({3, 600, 15, "subt"}, "", {.count = true}), NextMap::MayBeTheSame);
  EXPECT_EQ(map_after({3, 540, 14, "subt"}, "2"), NextMap::Empty) << "the confirmed name decides";
}

TEST(NextMap, MayBeTheSameUntilAnotherNameIsConfirmed) {
  dispatch::Run before = run_at(600);
  before.heard = 60;
  EXPECT_EQ(next_map(before, {.number = 2, .id = "2", .began = 70, .may_be = 1, .signs = {.name = true}}),
            NextMap::MayBeTheSame);
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
  EXPECT_TRUE(can_show_other_run(run));
  run.status_clock->runs = false;
  EXPECT_FALSE(can_show_other_run(run)) << "although the answers' clock runs";
  EXPECT_FALSE(can_show_other_run({}));
}

}  // namespace
}  // namespace adit::dispatch
