#include "host/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace adit::host {
namespace {

TEST(Random, FillsExactlyItsBuffer) {
  std::array<std::uint8_t, 32> either{};  // bits that were set at least once
  for (int i = 0; i < 64; ++i) {
    std::array<std::uint8_t, 34> bytes{};
    fill_random(std::span(bytes).subspan(1, 32));
    EXPECT_EQ(bytes.front(), 0);
    EXPECT_EQ(bytes.back(), 0);
    for (std::size_t each = 0; each < either.size(); ++each) either.at(each) |= bytes.at(each + 1);
  }
  EXPECT_EQ(std::ranges::count(either, 0xff), 32);
}

TEST(Random, IsNeverTheSameTwice) {
  std::array<std::uint8_t, 16> one{}, other{};
  fill_random(one);
  fill_random(other);
  EXPECT_NE(one, other);
}

TEST(Random, IsGivenUpToItsLimit) {
  std::array<std::uint8_t, 256> bytes{};
  fill_random(bytes);
  EXPECT_NE(bytes, (std::array<std::uint8_t, 256>{}));
  fill_random({});
}

}  // namespace
}  // namespace adit::host
