#include "dispatch/runs.hpp"

#include <gtest/gtest.h>

namespace adit::dispatch {
namespace {

Run run(std::int64_t number, std::int64_t turn, const std::string& post = "a:1") {
  return {.number = number, .post = post, .turn = turn};
}

TEST(Runs, HaveAFirstRunIfNoneIsKnown) {
  Runs runs;
  runs.open({}, 1);
  EXPECT_EQ(runs.present().number, 1);
}

TEST(Runs, ContinueThePresentRun) {
  Runs runs;
  runs.open({run(1, 3), run(2, 2, "b:1")}, 2);
  EXPECT_EQ(runs.present().number, 1);
}

TEST(Runs, ContinueTheLatestRunOfAReport) {
  Runs runs;
  runs.open({run(1, 1), run(2, 2)}, 3);
  EXPECT_EQ(runs.present().number, 3);
}

TEST(Runs, ContinueANewerRunOfAnOlderVersion) {
  Runs runs;
  runs.open({run(1, 3), run(2, 2, "b:1"), run(3, 0)}, 3);
  EXPECT_EQ(runs.present().number, 3);
  EXPECT_EQ(runs.present().turn, 4);
}

TEST(Runs, ContinueAResumedRunAfterARestart) {
  Runs runs;
  runs.open({}, 1);
  runs.begin({.post = "b:1"});
  EXPECT_EQ(runs.present().number, 2);
  runs.adopt(1);
  std::vector<dispatch::Run> kept;
  for (const auto& [number, each] : runs.all()) kept.push_back(each);
  Runs again;
  again.open(kept, 2);
  EXPECT_EQ(again.present().number, 1);
  again.begin({.post = "c:1"});
  EXPECT_EQ(again.present().number, 3);
}

TEST(Runs, FindTheLatestRunOfACommandPost) {
  Runs runs;
  runs.open({run(1, 1), run(2, 2, "b:1"), run(3, 3), run(4, 4, "b:1")}, 4);
  const auto at = [&](const std::string& post) {
    const dispatch::Run* const found = runs.latest_at(post);
    return found == nullptr ? 0 : found->number;
  };
  EXPECT_EQ(at("a:1"), 3);
  EXPECT_EQ(at("b:1"), 2) << "the present run is left out";
  EXPECT_EQ(at("c:1"), 0);
}

TEST(Runs, FindRunsThatMayStillGoOn) {
  dispatch::Run third = run(3, 3);
  third.may_be = 2;
  dispatch::Run fourth = run(4, 4);
  fourth.may_be = 3;
  Runs runs;
  runs.open({run(1, 1), run(2, 2), third, fourth}, 4);
  EXPECT_TRUE(runs.can_be_present(3));
  EXPECT_TRUE(runs.can_be_present(2));
  EXPECT_FALSE(runs.can_be_present(1));
  EXPECT_FALSE(runs.can_be_present(4));
}

TEST(Runs, FindRunsOfThisCommandPost) {
  Runs runs;
  runs.open({run(1, 1), run(2, 2, "b:1")}, 2);
  EXPECT_TRUE(runs.is_here(2));
  EXPECT_FALSE(runs.is_here(1));
  EXPECT_TRUE(runs.is_here(0)) << "of a version without runs";
}

}  // namespace
}  // namespace adit::dispatch
