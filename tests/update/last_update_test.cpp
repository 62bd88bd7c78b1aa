#include <gtest/gtest.h>

#include "update/messages.hpp"

namespace adit::update {
namespace {

const RunningSystem kOld = {"adit-board", "0.1.0", "A", "B"}, kNew = {"adit-board", "0.2.0", "B", "A"};

LastUpdate last_update(Stage stage) {
  return {.stage = stage, .version = "0.2.0", .slot = "B", .boot = "first", .why = "because"};
}

TEST(LastUpdate, InstalledWaitsForTheRestart) {
  EXPECT_EQ(settle_update(last_update(Stage::Installed), kOld, "first"), last_update(Stage::Installed));
  EXPECT_FALSE(on_trial(last_update(Stage::Installed), kOld, "first"));
}

TEST(LastUpdate, RunningIsATrial) {
  EXPECT_EQ(settle_update(last_update(Stage::Installed), kNew, "second").stage, Stage::Installed);
  EXPECT_TRUE(on_trial(last_update(Stage::Installed), kNew, "second"));
}

TEST(LastUpdate, IsLeftIfTheOldSlotRunsAgain) {
  const LastUpdate left = settle_update(last_update(Stage::Installed), kOld, "second");
  EXPECT_EQ(left.stage, Stage::Left);
  EXPECT_EQ(left.version, "0.2.0");
  EXPECT_EQ(left.why, "the update did not become healthy in three starts; 0.1.0 is running again");
  EXPECT_FALSE(on_trial(left, kOld, "second"));
}

TEST(LastUpdate, RunningIsATrialEvenIfItsEndWasNotSeen) {
  for (const Stage stage : {Stage::Installing, Stage::Interrupted, Stage::Failed, Stage::Left}) {
    EXPECT_TRUE(on_trial(last_update(stage), kNew, "second")) << name_of(stage);
    const LastUpdate whole = settle_update(last_update(stage), kNew, "second");
    EXPECT_EQ(whole.stage, Stage::Installed) << name_of(stage);
    EXPECT_EQ(whole.why, "") << name_of(stage);
    EXPECT_TRUE(on_trial(whole, kNew, "second"));
    EXPECT_EQ(settle_update(whole, kOld, "third").stage, Stage::Left) << name_of(stage);
    EXPECT_FALSE(on_trial(last_update(stage), kOld, "second")) << name_of(stage);
  }
}

TEST(LastUpdate, AnotherVersionIsNoTrial) {
  RunningSystem before = kNew;
  before.version = "0.1.0";
  for (const Stage stage : {Stage::Installing, Stage::Interrupted, Stage::Failed, Stage::Installed}) {
    EXPECT_FALSE(on_trial(last_update(stage), before, "second")) << name_of(stage);
  }
  EXPECT_EQ(settle_update(last_update(Stage::Installing), before, "second").stage, Stage::Interrupted);
  EXPECT_EQ(settle_update(last_update(Stage::Failed), before, "second"), last_update(Stage::Failed));
}

TEST(LastUpdate, InterruptedIsOverInThisOrTheNextBoot) {
  for (const char* boot : {"first", "second"}) {
    const LastUpdate broken = settle_update(last_update(Stage::Installing), kOld, boot);
    EXPECT_EQ(broken.stage, Stage::Interrupted) << boot;
    EXPECT_EQ(broken.why,
              "the update was interrupted: the running slot is unchanged, install the update again");
  }
}

TEST(LastUpdate, FinishedByRaucWaitsForTheRestart) {
  RunningSystem finished = kOld;
  finished.other_next = true;
  for (const Stage stage : {Stage::Installing, Stage::Interrupted, Stage::Failed}) {
    const LastUpdate whole = settle_update(last_update(stage), finished, "first");
    EXPECT_EQ(whole.stage, Stage::Installed) << name_of(stage);
    EXPECT_EQ(whole.why, "") << name_of(stage);
    EXPECT_FALSE(on_trial(whole, kOld, "first"));
  }
  EXPECT_EQ(settle_update(last_update(Stage::Good), finished, "first").stage, Stage::Good);
}

TEST(LastUpdate, EndedStaysUnchanged) {
  for (const Stage stage : {Stage::None, Stage::Good}) {
    for (const RunningSystem& running : {kOld, kNew}) {
      EXPECT_EQ(settle_update(last_update(stage), running, "third"), last_update(stage)) << name_of(stage);
      EXPECT_FALSE(on_trial(last_update(stage), running, "third")) << name_of(stage);
    }
  }
  for (const Stage stage : {Stage::Interrupted, Stage::Failed, Stage::Left}) {
    EXPECT_EQ(settle_update(last_update(stage), kOld, "third"), last_update(stage)) << name_of(stage);
  }
}

const ProvenSlot kNone, kA = {"A", "0.2.0"};
const RunningSystem kRunsA = {"adit-board", "0.2.0", "A", "B"}, kRunsB = {"adit-board", "0.1.0", "B", "A"};

TEST(ProvenSlot, IsTheRunningSlotIfUnknown) {
  EXPECT_EQ(proven_now(kNone, kRunsB, false), (ProvenSlot{"B", "0.1.0"}));
}

TEST(ProvenSlot, FollowsANewVersionOfItsSlot) {
  RunningSystem newer = kRunsA;
  newer.version = "0.3.0";
  EXPECT_EQ(proven_now(kA, newer, false), (ProvenSlot{"A", "0.3.0"}));
}

TEST(ProvenSlot, FollowsASlotOnlyAfterItsTrial) {
  EXPECT_EQ(proven_now(kA, kRunsB, false), kA);
  EXPECT_EQ(proven_now(kA, kRunsB, true), (ProvenSlot{"B", "0.1.0"}));
}

TEST(ProvenSlot, UnexpectedSlotIsReportedWithTheReason) {
  EXPECT_EQ(
      slot_warning(kA, kRunsB, false),
      "slot B is running, with 0.1.0, not slot A with 0.2.0, because that slot has used up its starts, by "
      "power cuts or because it does not come up");
  RunningSystem chosen = kRunsB;
  chosen.other_good = true;
  EXPECT_EQ(
      slot_warning(kA, chosen, false),
      "slot B is running, with 0.1.0, not slot A with 0.2.0, although that slot has starts left: a user "
      "chose the running slot, or the boot loader lost its counts");
}

TEST(ProvenSlot, ExpectedSlotAndTrialAreNotReported) {
  EXPECT_EQ(slot_warning(kA, kRunsA, false), "");
  EXPECT_EQ(slot_warning(kA, kRunsB, true), "");
  EXPECT_EQ(slot_warning(kNone, kRunsB, false), "");
}

}  // namespace
}  // namespace adit::update
