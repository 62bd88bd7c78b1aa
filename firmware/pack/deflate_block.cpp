#include "pack/deflate_block.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "pack/code_lengths.hpp"

namespace adit::pack {
namespace {

static_assert(std::endian::native == std::endian::little);  // BitWriter

constexpr int kMostCodeBits = 15, kMostBitsOfLengths = 7;
constexpr std::size_t kLeastLetters = 257, kLeastDistances = 1, kLeastLengths = 4;
/// The order of the lengths of the lengths' own code (RFC 1951 3.2.7).
constexpr std::array<std::uint8_t, 19> kOrder{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                              11, 4,  12, 3, 13, 2, 14, 1, 15};

/// A length, or that one is repeated.
struct Said {
  std::uint8_t symbol = 0, extra_bits = 0, extra = 0;
};

/// A run of the same length: said once and repeated, or zeros.
void say_run(std::vector<Said>& said, std::uint8_t length, std::size_t count) {
  constexpr std::size_t kLeast = 3, kMostRepeats = 6, kFewZeros = 10, kMostZeros = 138;
  if (length != 0) {
    said.push_back({length});
    --count;
  }
  while (count >= kLeast) {
    const std::size_t some = std::min(count, length != 0 ? kMostRepeats : kMostZeros);
    if (length != 0) {
      said.push_back({16, 2, static_cast<std::uint8_t>(some - kLeast)});
    } else if (some <= kFewZeros) {
      said.push_back({17, 3, static_cast<std::uint8_t>(some - kLeast)});
    } else {
      said.push_back({18, 7, static_cast<std::uint8_t>(some - kFewZeros - 1)});
    }
    count -= some;
  }
  said.insert(said.end(), count, {length});
}

std::vector<Said> say(std::span<const std::uint8_t> lengths) {
  std::vector<Said> said;
  while (!lengths.empty()) {
    const auto end =
        std::ranges::find_if(lengths, [&](std::uint8_t each) { return each != lengths.front(); });
    const auto count = static_cast<std::size_t>(end - lengths.begin());
    say_run(said, lengths.front(), count);
    lengths = lengths.subspan(count);
  }
  return said;
}

/// Without the zeros at the end, as far as may be.
std::size_t used(std::span<const std::uint8_t> lengths, std::size_t least) {
  std::size_t count = lengths.size();
  while (count > least && lengths[count - 1] == 0) --count;
  return count;
}

void write_head(BitWriter& out, const SymbolLengths& lengths) {
  const std::size_t letters = used(lengths.letters, kLeastLetters);
  const std::size_t distances = used(lengths.distances, kLeastDistances);
  std::vector<std::uint8_t> both(lengths.letters.begin(), lengths.letters.begin() + letters);
  both.insert(both.end(), lengths.distances.begin(), lengths.distances.begin() + distances);
  const std::vector<Said> said = say(both);
  std::array<std::uint32_t, kOrder.size()> counts{};
  for (const Said& each : said) ++counts[each.symbol];
  std::array<std::uint8_t, kOrder.size()> own{}, ordered{};
  std::array<std::uint16_t, kOrder.size()> codes{};
  code_lengths(counts, kMostBitsOfLengths, own);
  codes_of(own, codes);
  std::ranges::transform(kOrder, ordered.begin(), [&](std::uint8_t symbol) { return own[symbol]; });
  const std::size_t shown = used(ordered, kLeastLengths);
  out.put(letters - kLeastLetters, 5);
  out.put(distances - kLeastDistances, 5);
  out.put(shown - kLeastLengths, 4);
  for (std::size_t i = 0; i < shown; ++i) out.put(ordered[i], 3);
  for (const Said& each : said) {
    out.put(codes[each.symbol], own[each.symbol]);
    out.put(each.extra, each.extra_bits);
  }
}

/// A symbol's code, and how long it is.
struct Code {
  std::uint16_t bits = 0;
  std::uint8_t length = 0;
};

template <std::size_t Count>
std::array<Code, Count> table_of(const std::array<std::uint8_t, Count>& lengths) {
  std::array<std::uint16_t, Count> codes{};
  codes_of(lengths, codes);
  std::array<Code, Count> table{};
  for (std::size_t i = 0; i < Count; ++i) table[i] = {codes[i], lengths[i]};
  return table;
}

}  // namespace

void SymbolCounts::add(std::span<const Token> tokens) {
  for (const Token& token : tokens) {
    ++letters[token.length == 0 ? token.value : kLengthSymbols[token.length].symbol];
    if (token.length != 0) ++distances[symbol_of_distance(token.value).symbol];
  }
}

/// A block without copies has one distance all the same, of one bit.
SymbolLengths lengths_for(SymbolCounts counts) {
  SymbolLengths lengths;
  counts.letters[kEndOfBlock] = 1;
  code_lengths(counts.letters, kMostCodeBits, lengths.letters);
  code_lengths(counts.distances, kMostCodeBits, lengths.distances);
  if (std::ranges::max(lengths.distances) == 0) lengths.distances[0] = 1;
  return lengths;
}

void write_block(BitWriter& out, std::span<const Token> tokens, const SymbolCounts& counts, bool is_last) {
  const SymbolLengths lengths = lengths_for(counts);
  constexpr unsigned kOwnCode = 2;
  out.put((is_last ? 1U : 0U) | kOwnCode << 1U, 3);
  write_head(out, lengths);
  const auto letters = table_of(lengths.letters);
  const auto distances = table_of(lengths.distances);
  for (const Token& token : tokens) {
    if (token.length == 0) {
      out.put(letters[token.value].bits, letters[token.value].length);
      continue;
    }
    const Symbol length = kLengthSymbols[token.length], distance = symbol_of_distance(token.value);
    const Code first = letters[length.symbol], second = distances[distance.symbol];
    const std::uint64_t copied = first.bits | std::uint64_t{length.extra} << first.length;
    const std::uint64_t back = second.bits | std::uint64_t{distance.extra} << second.length;
    const unsigned bits = first.length + length.extra_bits;
    out.put(copied | back << bits, bits + second.length + distance.extra_bits);
  }
  out.put(letters[kEndOfBlock].bits, letters[kEndOfBlock].length);
}

}  // namespace adit::pack
