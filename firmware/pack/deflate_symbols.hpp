#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace adit::pack {

/// What a DEFLATE stream says one after the other (RFC 1951 3.2.3): a byte, or a copy of what lies `distance`
/// bytes back.
struct Token {
  std::uint16_t length = 0;  // of a copy, kLeastCopy to kMostCopy; 0: a byte
  std::uint16_t value = 0;   // the byte, or the distance less 1
};
inline constexpr std::size_t kLeastCopy = 3, kMostCopy = 258, kMostDistance = 32768;

/// The two alphabets (RFC 1951 3.2.5): bytes, the end of a block and lengths; distances.
inline constexpr std::size_t kLetters = 286, kDistances = 30, kEndOfBlock = 256;

/// A symbol, and the bits that follow its code.
struct Symbol {
  std::uint16_t symbol = 0;
  std::uint8_t extra_bits = 0;
  std::uint16_t extra = 0;
};

/// `length`: of a copy.
constexpr Symbol symbol_of_length(unsigned length) {
  if (length == kMostCopy) return {285, 0, 0};
  const unsigned from = length - static_cast<unsigned>(kLeastCopy);
  if (from < 8) return {static_cast<std::uint16_t>(257 + from), 0, 0};
  const unsigned bits = static_cast<unsigned>(std::bit_width(from)) - 3;
  const unsigned symbol = 257 + 4 * bits + (from >> bits);
  return {static_cast<std::uint16_t>(symbol), static_cast<std::uint8_t>(bits),
          static_cast<std::uint16_t>(from & ((1U << bits) - 1))};
}

/// `less_1`: a distance less 1.
constexpr Symbol symbol_of_distance(unsigned less_1) {
  if (less_1 < 4) return {static_cast<std::uint16_t>(less_1), 0, 0};
  const unsigned bits = static_cast<unsigned>(std::bit_width(less_1)) - 2;
  const unsigned symbol = 2 * bits + (less_1 >> bits);
  return {static_cast<std::uint16_t>(symbol), static_cast<std::uint8_t>(bits),
          static_cast<std::uint16_t>(less_1 & ((1U << bits) - 1))};
}

/// Of each length of a copy, by which it is looked up for each token.
inline constexpr auto kLengthSymbols = [] {
  std::array<Symbol, kMostCopy + 1> all{};
  for (unsigned length = kLeastCopy; length <= kMostCopy; ++length) all[length] = symbol_of_length(length);
  return all;
}();

}  // namespace adit::pack
