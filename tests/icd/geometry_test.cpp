#include "icd/geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace adit::icd {
namespace {

double length_of(const Quaternion& q) {
  return std::hypot(std::hypot(q.x, q.y, q.z), q.w);
}

TEST(Rotation, IsNormalized) {
  for (const double length :
       {1e-5, 0.5, 1 - 2e-6, 1 + 2e-6, 3.0, 1e200, std::numeric_limits<double>::max()}) {
    const auto rotation = rotation_of({0.36 * length, -0.48 * length, 0.64 * length, 0.48 * length});
    ASSERT_TRUE(rotation) << length;
    EXPECT_NEAR(length_of(*rotation), 1, 1e-15) << length;
    EXPECT_NEAR(rotation->x, 0.36, 1e-15) << length;
    EXPECT_NEAR(rotation->y, -0.48, 1e-15) << length;
    EXPECT_NEAR(rotation->z, 0.64, 1e-15) << length;
    EXPECT_NEAR(rotation->w, 0.48, 1e-15) << length;
  }
}

TEST(Rotation, KeepsAnAlmostNormalQuaternionExactly) {
  for (const double length : {1 - 0.9e-6, 1.0, 1 + 0.9e-6}) {
    const Quaternion given{0.36 * length, -0.48 * length, 0.64 * length, 0.48 * length};
    EXPECT_EQ(rotation_of(given), given) << length;
  }
  const auto zero = rotation_of({-0.0, 0, 0, 1});
  ASSERT_TRUE(zero);
  EXPECT_TRUE(std::signbit(zero->x));
}

TEST(Rotation, IsTheIdentityForAllZeros) {
  EXPECT_EQ(rotation_of({0, -0.0, 0, 0}), Quaternion{});
}

TEST(Rotation, RejectsNonFiniteAndZeroLength) {
  using Double = std::numeric_limits<double>;
  for (const double odd : {Double::quiet_NaN(), Double::infinity(), -Double::infinity()}) {
    EXPECT_FALSE(rotation_of({odd, 0, 0, 1}));
    EXPECT_FALSE(rotation_of({0, odd, 0, 1}));
    EXPECT_FALSE(rotation_of({0, 0, odd, 1}));
    EXPECT_FALSE(rotation_of({0, 0, 0, odd}));
  }
  for (const double shortest : {9e-7, 1e-200, Double::denorm_min()})
    EXPECT_FALSE(rotation_of({0, 0, 0, shortest})) << shortest;
}

}  // namespace
}  // namespace adit::icd
