#include "pack/deflate_symbols.hpp"

#include <gtest/gtest.h>

namespace adit::pack {
namespace {

/// RFC 1951 3.2.5: the least of each symbol, and its extra bits.
constexpr unsigned kLengths[] = {3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                 31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
constexpr unsigned kLengthBits[] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                    2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
constexpr unsigned kFar[] = {1,    2,    3,    4,    5,    7,    9,    13,    17,    25,
                             33,   49,   65,   97,   129,  193,  257,  385,   513,   769,
                             1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
constexpr unsigned kFarBits[] = {0, 0, 0, 0, 1, 1, 2, 2,  3,  3,  4,  4,  5,  5,  6,
                                 6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13};

TEST(SymbolOfLength, IsRfc1951s) {
  for (unsigned length = kLeastCopy; length <= kMostCopy; ++length) {
    const Symbol& symbol = kLengthSymbols[length];
    const unsigned i = symbol.symbol - 257U;
    ASSERT_LT(i, std::size(kLengths));
    EXPECT_EQ(kLengths[i] + symbol.extra, length);
    EXPECT_EQ(symbol.extra_bits, kLengthBits[i]);
    EXPECT_LT(symbol.extra, 1U << symbol.extra_bits);
  }
  EXPECT_EQ(kLengthSymbols[kMostCopy].symbol, 285);
}

TEST(SymbolOfDistance, IsRfc1951s) {
  for (unsigned distance = 1; distance <= kMostDistance; ++distance) {
    const Symbol symbol = symbol_of_distance(distance - 1);
    ASSERT_LT(symbol.symbol, std::size(kFar));
    EXPECT_EQ(kFar[symbol.symbol] + symbol.extra, distance);
    EXPECT_EQ(symbol.extra_bits, kFarBits[symbol.symbol]);
    EXPECT_LT(symbol.extra, 1U << symbol.extra_bits);
  }
}

}  // namespace
}  // namespace adit::pack
