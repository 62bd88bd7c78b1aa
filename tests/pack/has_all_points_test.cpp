#include "pack/has_all_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <span>
#include <vector>

namespace adit::pack {
namespace {

constexpr std::size_t kStep = 12;

/// Points of 12 bytes identified by their numbers, in chunks of that size.
icd::MapData points(const std::vector<std::uint32_t>& numbers, std::size_t chunk = 1 << 16) {
  std::vector<std::uint8_t> bytes(kStep * numbers.size());
  for (std::size_t i = 0; i < bytes.size(); i += 4) std::memcpy(&bytes[i], &numbers[i / kStep], 4);
  icd::MapData data{{}, icd::Compression::None, bytes.size()};
  for (std::size_t at = 0; at < bytes.size(); at += chunk) {
    const auto piece = std::span(bytes).subspan(at, std::min(chunk, bytes.size() - at));
    data.bytes.append(std::vector<std::uint8_t>(piece.begin(), piece.end()));
  }
  return data;
}

bool has(const std::vector<std::uint32_t>& newer, const std::vector<std::uint32_t>& older) {
  return has_all_points(points(newer), points(older, 7), kStep);
}

TEST(HasAllPoints, OfAnExtendedCloud) {
  EXPECT_TRUE(has({1, 2, 3}, {1, 2}));
  EXPECT_TRUE(has({1, 2, 3}, {1, 2, 3}));
  EXPECT_TRUE(has({1}, {}));
  EXPECT_TRUE(has({}, {}));
}

TEST(HasAllPoints, InAnyOrder) {
  EXPECT_TRUE(has({3, 2, 1}, {1, 2}));
  EXPECT_TRUE(has({3, 1, 2, 1}, {1, 1, 2})) << "each point is there";
}

TEST(HasAllPoints, IsFalseIfOneIsMissing) {
  EXPECT_FALSE(has({1, 2}, {1, 2, 3}));
  EXPECT_FALSE(has({1, 3, 4}, {1, 2}));
  EXPECT_FALSE(has({}, {1}));
  EXPECT_FALSE(has({4, 5, 6}, {1, 2, 3}));
}

TEST(HasAllPoints, IsFalseIfOneByteDiffers) {
  for (std::size_t i = 0; i < kStep; ++i) {
    auto bytes = points({1, 2, 3}).bytes.to_vector();
    ++bytes[kStep + i];
    const icd::MapData other{icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()};
    EXPECT_FALSE(has_all_points(points({3, 2, 1}), other, kStep)) << i;
  }
}

TEST(HasAllPoints, FindsOneMissingPointOfMany) {
  std::vector<std::uint32_t> older(20'000), newer;
  for (std::uint32_t i = 0; i < older.size(); ++i) older[i] = i * 977;
  newer = older;
  std::ranges::reverse(newer);
  EXPECT_TRUE(has(newer, older));
  for (const std::size_t missing : {std::size_t{1}, std::size_t{9'999}, std::size_t{19'998}}) {
    auto without = newer;
    without[missing] = 1;
    EXPECT_FALSE(has(without, older)) << missing;
  }
}

TEST(HasAllPoints, MatchesComparisonOfSets) {
  std::mt19937 random{7};
  const auto drawn = [&](std::size_t most) {
    std::vector<std::uint32_t> numbers(random() % (most + 1));
    for (auto& number : numbers) number = static_cast<std::uint32_t>(random() % 6);
    return numbers;
  };
  for (int i = 0; i < 3000; ++i) {
    const auto newer = drawn(12), older = drawn(6);
    const std::set<std::uint32_t> in_newer(newer.begin(), newer.end()), in_older(older.begin(), older.end());
    const bool includes = std::ranges::includes(in_newer, in_older) && older.size() <= newer.size();
    EXPECT_EQ(has(newer, older), includes);
  }
}

TEST(HasAllPoints, ComparesOnlyPrefixesOfTooManyPoints) {
  std::vector<std::uint32_t> older(kMostComparedPoints);
  for (std::uint32_t i = 0; i < older.size(); ++i) older[i] = i;
  auto newer = older;
  newer.push_back(7);
  const icd::MapData all = points(older);
  EXPECT_TRUE(has_all_points(points(newer), all, kStep));
  std::swap(newer.front(), newer.back());
  EXPECT_FALSE(has_all_points(points(newer), all, kStep)) << "in doubt every point must be sent";
}

}  // namespace
}  // namespace adit::pack
