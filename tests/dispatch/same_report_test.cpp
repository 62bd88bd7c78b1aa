#include <gtest/gtest.h>

#include <array>

#include "dispatch/report.hpp"

namespace adit::dispatch {
namespace {

using icd::ArtifactReport;

TEST(SameReport, HasTheSameTypeInAnyLetterCase) {
  EXPECT_TRUE(is_same({"Cell Phone", {1, 2, 3}}, {"cell phone", {1, 2, 3}}));
  EXPECT_FALSE(is_same({"Cell Phone", {1, 2, 3}}, {"CellPhone", {1, 2, 3}}));
  EXPECT_FALSE(is_same({"Gas", {1, 2, 3}}, {"Vent", {1, 2, 3}}));
}

TEST(SameReport, IsWithinAMillimetreOnEachAxis) {
  EXPECT_TRUE(is_same({"Gas", {1, 2, 3}}, {"Gas", {1.0009, 1.9991, 3.0009}}));
  EXPECT_TRUE(is_same({"Gas", {12.3, 45.6, -7.8}}, {"Gas", {12.3F, 45.6F, -7.8F}})) << "rounded to float32";
  EXPECT_FALSE(is_same({"Gas", {1, 2, 3}}, {"Gas", {1.0011, 2, 3}}));
  EXPECT_FALSE(is_same({"Gas", {1, 2, 3}}, {"Gas", {1, 2.0011, 3}}));
  EXPECT_FALSE(is_same({"Gas", {1, 2, 3}}, {"Gas", {1, 2, 2.9989}}));
}

TEST(SameReport, MayNameAnotherRobot) {
  const ArtifactReport one{"Gas", {1, 2, 3}, icd::RobotName::parse("spot1")};
  EXPECT_TRUE(is_same(one, {"Gas", {1, 2, 3}, icd::RobotName::parse("spot2")}));
  EXPECT_TRUE(is_same(one, {"Gas", {1, 2, 3}}));
}

TEST(NearReport, HasTheSameTypeWithinTheDistance) {
  const ArtifactReport one{"Gas", {1, 2, 3}};
  EXPECT_TRUE(is_near(one, {"gas", {4, 6, 3}}, 5));
  EXPECT_FALSE(is_near(one, {"Gas", {4, 6, 3.1}}, 5));
  EXPECT_FALSE(is_near(one, {"Vent", {1, 2, 3}}, 5));
  EXPECT_TRUE(is_near(one, one, 0));
}

TEST(NearReport, IsSymmetricAndIncludesTheSame) {
  const std::array all = {ArtifactReport{"Gas", {1, 2, 3}}, ArtifactReport{"GAS", {1.001, 2, 3}},
                          ArtifactReport{"Gas", {-4, 2, 9}}, ArtifactReport{"Vent", {1, 2, 3}}};
  for (const auto& one : all) {
    for (const auto& other : all) {
      EXPECT_EQ(is_near(one, other, 7), is_near(other, one, 7));
      EXPECT_EQ(is_same(one, other), is_same(other, one));
      EXPECT_TRUE(!is_same(one, other) || is_near(one, other, 2 * kSamePlace));
    }
  }
}

TEST(Distance, IsInMetres) {
  EXPECT_DOUBLE_EQ(distance({"Gas", {0, 0, 0}}, {"Gas", {2, 3, 6}}), 7);
}

}  // namespace
}  // namespace adit::dispatch
