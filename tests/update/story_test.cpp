#include "update/story.hpp"

#include <gtest/gtest.h>

namespace adit::update {
namespace {

const Running kOld = {"adit-board", "0.1.0", "A", "B"}, kNew = {"adit-board", "0.2.0", "B", "A"};

Story story(Stage stage) {
  return {.stage = stage, .version = "0.2.0", .slot = "B", .boot = "first", .why = "because"};
}

TEST(Story, OfAnInstalledUpdateWaitsForTheRestart) {
  EXPECT_EQ(settled(story(Stage::Installed), kOld, "first"), story(Stage::Installed));
  EXPECT_FALSE(on_trial(story(Stage::Installed), "A", "first"));
}

TEST(Story, OfAnUpdateThatRunsIsATrial) {
  EXPECT_EQ(settled(story(Stage::Installed), kNew, "second").stage, Stage::Installed);
  EXPECT_TRUE(on_trial(story(Stage::Installed), "B", "second"));
}

TEST(Story, SaysThatAnUpdateWasLeftWhenTheOldSlotRunsAgain) {
  const Story left = settled(story(Stage::Installed), kOld, "second");
  EXPECT_EQ(left.stage, Stage::Left);
  EXPECT_EQ(left.version, "0.2.0");
  EXPECT_EQ(left.why, "it did not come up healthy in three starts, and 0.1.0 runs again");
  EXPECT_FALSE(on_trial(left, "A", "second"));
}

TEST(Story, OfASlotThatRunsIsATrialWhateverWasSeenOfTheEndOfItsWriting) {
  for (const Stage stage : {Stage::Installing, Stage::Interrupted, Stage::Failed}) {
    EXPECT_TRUE(on_trial(story(stage), "B", "second")) << name_of(stage);
    const Story whole = settled(story(stage), kNew, "second");
    EXPECT_EQ(whole.stage, Stage::Installed) << name_of(stage);
    EXPECT_EQ(whole.why, "") << name_of(stage);
    EXPECT_TRUE(on_trial(whole, "B", "second"));
    EXPECT_EQ(settled(whole, kOld, "third").stage, Stage::Left) << name_of(stage);
    EXPECT_FALSE(on_trial(story(stage), "A", "second")) << name_of(stage);
  }
}

TEST(Story, OfAnInterruptedInstallationIsOverInThisStartOrTheNext) {
  for (const char* boot : {"first", "second"}) {
    const Story broken = settled(story(Stage::Installing), kOld, boot);
    EXPECT_EQ(broken.stage, Stage::Interrupted) << boot;
    EXPECT_EQ(broken.why, "it was interrupted: what runs was not touched, install it again");
  }
}

TEST(Story, OfAnInstallationThatRaucFinishedByItselfWaitsForTheRestart) {
  Running finished = kOld;
  finished.other_next = true;
  for (const Stage stage : {Stage::Installing, Stage::Interrupted, Stage::Failed}) {
    const Story whole = settled(story(stage), finished, "first");
    EXPECT_EQ(whole.stage, Stage::Installed) << name_of(stage);
    EXPECT_EQ(whole.why, "") << name_of(stage);
    EXPECT_FALSE(on_trial(whole, "A", "first"));
  }
  EXPECT_EQ(settled(story(Stage::Good), finished, "first").stage, Stage::Good);
}

TEST(Story, ThatIsOverStaysAsItWas) {
  for (const Stage stage : {Stage::None, Stage::Left, Stage::Good}) {
    for (const Running& running : {kOld, kNew}) {
      EXPECT_EQ(settled(story(stage), running, "third"), story(stage)) << name_of(stage);
      EXPECT_FALSE(on_trial(story(stage), running.slot, "third")) << name_of(stage);
    }
  }
  for (const Stage stage : {Stage::Interrupted, Stage::Failed}) {
    EXPECT_EQ(settled(story(stage), kOld, "third"), story(stage)) << name_of(stage);
  }
}

}  // namespace
}  // namespace adit::update
