#include "update/proven.hpp"

#include <gtest/gtest.h>

namespace adit::update {
namespace {

const Proven kNone, kA = {"A", "0.2.0"};
const Running kRunsA = {"adit-board", "0.2.0", "A", "B"}, kRunsB = {"adit-board", "0.1.0", "B", "A"};

TEST(Proven, IsWhatRunsWhereNoneWasKnown) {
  EXPECT_EQ(proven_now(kNone, kRunsB, false), (Proven{"B", "0.1.0"}));
}

TEST(Proven, IsAnotherVersionOfTheSameSlot) {
  Running newer = kRunsA;
  newer.version = "0.3.0";
  EXPECT_EQ(proven_now(kA, newer, false), (Proven{"A", "0.3.0"}));
}

TEST(Proven, IsAnotherSlotOnceItHasPassedItsTrialAlone) {
  EXPECT_EQ(proven_now(kA, kRunsB, false), kA);
  EXPECT_EQ(proven_now(kA, kRunsB, true), (Proven{"B", "0.1.0"}));
}

TEST(Proven, AnotherSlotThatRunsIsToldWithBothVersionsAndWhy) {
  EXPECT_EQ(
      stray(kA, kRunsB, false),
      "slot B is running, with 0.1.0, not slot A with 0.2.0, because that slot has used up its starts, by "
      "power cuts or because it does not come up");
  Running chosen = kRunsB;
  chosen.other_good = true;
  EXPECT_EQ(
      stray(kA, chosen, false),
      "slot B is running, with 0.1.0, not slot A with 0.2.0, although that slot has starts left: a user "
      "chose the running slot, or the boot loader lost its counts");
}

TEST(Proven, NothingIsToldOfTheProvenSlotNorOfATrialNorWhereNoneIsKnown) {
  EXPECT_EQ(stray(kA, kRunsA, false), "");
  EXPECT_EQ(stray(kA, kRunsB, true), "");
  EXPECT_EQ(stray(kNone, kRunsB, false), "");
}

}  // namespace
}  // namespace adit::update
