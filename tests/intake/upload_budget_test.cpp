#include <gtest/gtest.h>

#include <optional>

#include "intake/uploads.hpp"

namespace adit::intake {
namespace {

TEST(UploadShare, StaysWithinTheBudget) {
  const auto budget = std::make_shared<UploadBudget>(100);
  UploadShare one(budget, "a"), other(budget, "b");
  EXPECT_TRUE(one.grow_to(60));
  EXPECT_FALSE(other.grow_to(41));
  EXPECT_TRUE(other.grow_to(15)) << "a failed attempt takes nothing";
  EXPECT_TRUE(one.grow_to(50)) << "a smaller size";
  EXPECT_FALSE(one.grow_to(76));
}

TEST(UploadShare, LeavesRoomForOtherAddresses) {
  const auto budget = std::make_shared<UploadBudget>(100);
  UploadShare one(budget, "a"), two(budget, "a"), three(budget, "a");
  EXPECT_TRUE(one.grow_to(60));
  EXPECT_TRUE(two.grow_to(15));
  EXPECT_FALSE(three.grow_to(1));
  UploadShare other(budget, "b"), third(budget, "c");
  EXPECT_TRUE(other.grow_to(12));
  EXPECT_FALSE(other.grow_to(13)) << "it would exceed the rest";
  EXPECT_TRUE(third.grow_to(6)) << "before the first has returned anything";
}

TEST(UploadShare, IsReturnedOnceAtItsEnd) {
  const auto budget = std::make_shared<UploadBudget>(100);
  {
    std::optional<UploadShare> share(std::in_place, budget, "a");
    EXPECT_TRUE(share->grow_to(60));
    EXPECT_TRUE(share->grow_to(75));
    EXPECT_FALSE(budget->reserve("b", 13));
  }
  EXPECT_TRUE(UploadShare(budget, "a").grow_to(75));
  EXPECT_FALSE(budget->reserve("a", 76));
  EXPECT_TRUE(budget->reserve("a", 75));
}

TEST(UploadShare, KeepsItsBudgetAlive) {
  auto budget = std::make_shared<UploadBudget>(100);
  const std::weak_ptr<UploadBudget> watched = budget;
  std::optional<UploadShare> share(std::in_place, std::move(budget), "a");
  EXPECT_TRUE(share->grow_to(75));
  EXPECT_FALSE(watched.expired());
  share.reset();
  EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace adit::intake
