#include "pack/code_lengths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <random>

namespace adit::pack {
namespace {

using Counts = std::vector<std::uint32_t>;
using Lengths = std::vector<std::uint8_t>;

Lengths lengths_of(const Counts& counts, int most_bits) {
  Lengths lengths(counts.size(), 99);
  code_lengths(counts, most_bits, lengths);
  return lengths;
}

/// Of all that the counts say.
std::uint64_t bits_of(const Counts& counts, const Lengths& lengths) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) bits += std::uint64_t{counts[i]} * lengths[i];
  return bits;
}

/// By Huffman's own way, without any limit.
std::uint64_t least_bits(const Counts& counts) {
  std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> trees;
  for (const std::uint32_t count : counts) {
    if (count > 0) trees.push(count);
  }
  std::uint64_t bits = 0;
  while (trees.size() > 1) {
    std::uint64_t both = trees.top();
    trees.pop();
    both += trees.top();
    trees.pop();
    trees.push(both);
    bits += both;
  }
  return bits;
}

/// Of all lengths up to `most_bits` that are a prefix code.
std::uint64_t least_bits_within(const Counts& counts, int most_bits, std::size_t at = 0, double used = 0) {
  if (used > 1) return UINT64_MAX / 2;
  if (at == counts.size()) return 0;
  std::uint64_t least = UINT64_MAX / 2;
  for (int bits = 1; bits <= most_bits; ++bits) {
    const std::uint64_t rest = least_bits_within(counts, most_bits, at + 1, used + std::ldexp(1, -bits));
    least = std::min(least, counts[at] * static_cast<std::uint64_t>(bits) + rest);
  }
  return least;
}

void expect_whole_code(const Counts& counts, const Lengths& lengths, int most_bits) {
  double used = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    ASSERT_EQ(lengths[i] == 0, counts[i] == 0);
    ASSERT_LE(lengths[i], most_bits);
    if (lengths[i] > 0) used += std::ldexp(1, -lengths[i]);
  }
  EXPECT_EQ(used, 1);
}

TEST(CodeLengths, AreHuffmansWhereTheLimitDoesNotBind) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 300; ++round) {
    Counts counts(2 + random() % 285);
    for (auto& count : counts) count = static_cast<std::uint32_t>(random() % 4 == 0 ? 0 : 1 + random() % 50);
    counts[0] = counts[1] = 1;
    const Lengths lengths = lengths_of(counts, 15);
    expect_whole_code(counts, lengths, 15);
    EXPECT_EQ(bits_of(counts, lengths), least_bits(counts));
  }
}

TEST(CodeLengths, AreTheBestWithinTheirLimit) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 200; ++round) {
    Counts counts(2 + random() % 5);
    for (auto& count : counts)
      count = 1 + static_cast<std::uint32_t>(random() % (random() % 2 == 0 ? 10 : 10'000));
    const int most_bits = 3 + static_cast<int>(random() % 2);
    const Lengths lengths = lengths_of(counts, most_bits);
    expect_whole_code(counts, lengths, most_bits);
    EXPECT_EQ(bits_of(counts, lengths), least_bits_within(counts, most_bits));
  }
}

TEST(CodeLengths, StayWithinTheLimitHoweverRareASymbolIs) {
  Counts fibonacci{1, 1};
  while (fibonacci.size() < 40) fibonacci.push_back(fibonacci.end()[-1] + fibonacci.end()[-2]);
  expect_whole_code(fibonacci, lengths_of(fibonacci, 15), 15);
  const Counts nineteen(fibonacci.begin(), fibonacci.begin() + 19);
  expect_whole_code(nineteen, lengths_of(nineteen, 7), 7);
}

TEST(CodeLengths, OfOneSymbolAreOneBitAndOfNoneNothing) {
  EXPECT_EQ(lengths_of({0, 7, 0}, 15), (Lengths{0, 1, 0}));
  EXPECT_EQ(lengths_of({0, 0}, 15), (Lengths{0, 0}));
  EXPECT_EQ(lengths_of({}, 15), Lengths{});
}

TEST(CodesOf, AreThoseOfRfc1951) {  // 3.2.2: A to H, with their first bit lowest
  const Lengths lengths{3, 3, 3, 3, 3, 2, 4, 4};
  std::vector<std::uint16_t> codes(8);
  codes_of(lengths, codes);
  EXPECT_EQ(codes, (std::vector<std::uint16_t>{0b010, 0b110, 0b001, 0b101, 0b011, 0b00, 0b0111, 0b1111}));
}

}  // namespace
}  // namespace adit::pack
