#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "archive/plot.hpp"

namespace adit::archive {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr Box kFrame{10, 20, 110, 90};

TEST(Labels, AreBesideTheirSignsAndAvoidOthers) {
  Labels labels{kFrame};
  const auto right = labels.place(50, 50, 1, 10, 3), left = labels.place(50, 50, 1, 10, 3);
  ASSERT_TRUE(right && left);
  EXPECT_GT(right->left, 51);
  EXPECT_LT(left->right, 49);
  EXPECT_EQ(left->right - left->left, 10);
  EXPECT_EQ(left->bottom - left->top, 3);
}

TEST(Labels, StayWithinTheFrameOrAreOmitted) {
  Labels labels{kFrame};
  const auto corner = labels.place(kFrame.right, kFrame.top, 1, 10, 3);
  ASSERT_TRUE(corner);
  EXPECT_TRUE(kFrame.contains(*corner));
  EXPECT_FALSE(labels.place(50, 50, 1, 101, 3));
}

/// A thousand signs at random places, or all at one place.
TEST(Labels, OverlapNoLabelAndNoSign) {
  for (const double spread : {100.0, 12.0, 0.0}) {
    std::mt19937 random{11};
    std::uniform_real_distribution<double> part{0, 1};
    Labels labels{kFrame};
    std::vector<Box> all;
    std::vector<std::pair<double, double>> signs;
    for (int i = 0; i < 1000; ++i) {
      signs.emplace_back(60 + spread * (part(random) - 0.5), 55 + 0.7 * spread * (part(random) - 0.5));
      const auto& [x, y] = signs.back();
      if (i % 50 != 0) continue;
      all.push_back({x - 1, y - 1, x + 1, y + 1});
      labels.keep_free(all.back());
    }
    const std::size_t taken = all.size();
    for (const auto& [x, y] : signs) {
      const auto box = labels.place(x, y, 1, 2 + 20 * part(random), 3);
      if (!box) continue;
      EXPECT_TRUE(kFrame.contains(*box));
      for (const Box& other : all) ASSERT_FALSE(box->overlaps(other));
      all.push_back(*box);
    }
    EXPECT_GT(all.size(), taken + 5) << "some labels fit";
  }
}

TEST(Labels, OfLongTextsEndWithAnEllipsis) {
  EXPECT_EQ(shorten("Backpack", 8), "Backpack");
  EXPECT_EQ(shorten("Backpacks", 8), "Backpac\u2026");
  EXPECT_EQ(shorten("\u00e4\u00f6\u00fc\u00df", 3), "\u00e4\u00f6\u2026");
  EXPECT_LT(width_of("ill", 10), width_of("WWW", 10));
  EXPECT_EQ(width_of("\u00e4", 10), width_of("W", 10));
}

TEST(Ticks, AreMultiplesOfOneTwoOrFive) {
  EXPECT_THAT(ticks(0, 60, 6), ElementsAre(0, 10, 20, 30, 40, 50, 60));
  EXPECT_THAT(ticks(-7, 12, 4), ElementsAre(-5, 0, 5, 10));
  EXPECT_THAT(ticks(0, 1, 4), ElementsAre(0, 0.5, 1));
  EXPECT_EQ(decimals_of(ticks(0, 1, 4)), 1);
  EXPECT_EQ(decimals_of(ticks(0, 0.05, 5)), 2);
  EXPECT_EQ(decimals_of(ticks(0, 60, 6)), 0);
}

TEST(Ticks, AreFewForAnyRange) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{
           {0, 0}, {1, -1}, {0, kInfinity}, {-kInfinity, 0}, {0, std::nan("")}})
    EXPECT_THAT(ticks(low, high, 5), IsEmpty());
  for (const double scale : {1e-12, 0.3, 1.0, 7.7, 1e9, 1e300}) {
    for (int most = 1; most < 12; ++most) {
      const auto all = ticks(-scale, scale * 2, most);
      ASSERT_LE(all.size(), static_cast<std::size_t>(most) + 1);
      ASSERT_GE(all.size(), 1U);
      for (const double each : all) EXPECT_TRUE(each >= -scale * 1.0001 && each <= scale * 2.0001);
    }
  }
}

}  // namespace
}  // namespace adit::archive
