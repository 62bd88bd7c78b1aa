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
  EXPECT_EQ(stray(kA, kRunsB, false),
            "slot B runs, with 0.1.0, not slot A with 0.2.0, whose starts were used up, by power cuts or "
            "because it "
            "does not come up");
  Running chosen = kRunsB;
  chosen.other_good = true;
  EXPECT_EQ(stray(kA, chosen, false),
            "slot B runs, with 0.1.0, not slot A with 0.2.0, though its starts are not used up: somebody "
            "chose this one, or the boot loader's counts were lost");
}

TEST(Proven, NothingIsToldOfTheProvenSlotNorOfATrialNorWhereNoneIsKnown) {
  EXPECT_EQ(stray(kA, kRunsA, false), "");
  EXPECT_EQ(stray(kA, kRunsB, true), "");
  EXPECT_EQ(stray(kNone, kRunsB, false), "");
}

}  // namespace
}  // namespace adit::update
