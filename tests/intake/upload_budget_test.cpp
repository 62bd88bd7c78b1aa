#include "intake/upload_budget.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace adit::intake {
namespace {

TEST(UploadShare, TakesNoMoreThanIsLeftForAll) {
  const auto budget = std::make_shared<UploadBudget>(100);
  UploadShare one(budget), other(budget);
  EXPECT_TRUE(one.take(60));
  EXPECT_FALSE(other.take(41));
  EXPECT_TRUE(other.take(40)) << "what was not taken is left";
  EXPECT_FALSE(one.take(1));
}

TEST(UploadShare, IsGivenBackWholeAtItsEndAndOnlyOnce) {
  const auto budget = std::make_shared<UploadBudget>(100);
  {
    std::optional<UploadShare> share(std::in_place, budget);
    EXPECT_TRUE(share->take(60));
    EXPECT_TRUE(share->take(30));
    EXPECT_FALSE(share->take(11));
    EXPECT_FALSE(budget->take(11));
  }
  EXPECT_FALSE(budget->take(101));
  EXPECT_TRUE(budget->take(100));
}

TEST(UploadShare, KeepsTheBudgetThatItGivesBackTo) {
  auto budget = std::make_shared<UploadBudget>(100);
  const std::weak_ptr<UploadBudget> watched = budget;
  std::optional<UploadShare> share(std::in_place, std::move(budget));
  EXPECT_TRUE(share->take(100));
  EXPECT_FALSE(watched.expired());
  share.reset();
  EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace adit::intake
