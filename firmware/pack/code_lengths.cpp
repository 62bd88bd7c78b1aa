#include "pack/code_lengths.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "icd/require.hpp"

namespace adit::pack {
namespace {

constexpr std::size_t kMostBits = 15;

/// Leaves and packages of one length, lightest first.
struct Coins {
  std::vector<std::uint64_t> weights;
  std::vector<bool> are_leaves;
};

/// The leaves, and beside them the coins of the length below in pairs.
Coins with_pairs(const std::vector<std::uint64_t>& leaves, const std::vector<std::uint64_t>& below) {
  Coins coins;
  const std::size_t pairs = below.size() / 2;
  std::size_t leaf = 0, pair = 0;
  while (leaf < leaves.size() || pair < pairs) {
    const std::uint64_t both = pair < pairs ? below[2 * pair] + below[2 * pair + 1] : 0;
    const bool is_leaf = pair == pairs || (leaf < leaves.size() && leaves[leaf] <= both);
    coins.weights.push_back(is_leaf ? leaves[leaf] : both);
    coins.are_leaves.push_back(is_leaf);
    ++(is_leaf ? leaf : pair);
  }
  return coins;
}

}  // namespace

void code_lengths(std::span<const std::uint32_t> counts, int most_bits, std::span<std::uint8_t> lengths) {
  icd::require(lengths.size() == counts.size());
  std::ranges::fill(lengths, std::uint8_t{0});
  std::vector<std::pair<std::uint64_t, std::size_t>> symbols;  // that occur, the rarest first
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) symbols.emplace_back(counts[i], i);
  }
  if (symbols.size() == 1) lengths[symbols.front().second] = 1;
  if (symbols.size() < 2) return;
  std::ranges::sort(symbols);
  std::vector<std::uint64_t> leaves;
  leaves.reserve(symbols.size());
  for (const auto& [count, symbol] : symbols) leaves.push_back(count);
  std::vector<Coins> rows;  // one for each length, the longest first
  for (int bits = most_bits; bits > 0; --bits) {
    rows.push_back(with_pairs(leaves, rows.empty() ? std::vector<std::uint64_t>{} : rows.back().weights));
  }
  std::size_t taken = 2 * symbols.size() - 2;  // coins of a row, the lightest
  while (!rows.empty()) {
    icd::require(taken <= rows.back().weights.size());
    std::size_t leaf = 0;
    for (std::size_t i = 0; i < taken; ++i) {
      if (rows.back().are_leaves[i]) ++lengths[symbols[leaf++].second];
    }
    taken = 2 * (taken - leaf);
    rows.pop_back();
  }
}

void codes_of(std::span<const std::uint8_t> lengths, std::span<std::uint16_t> codes) {
  std::array<unsigned, kMostBits + 2> next{};  // code of each length
  for (const std::uint8_t length : lengths) {
    if (length > 0) ++next[length + 1U];
  }
  for (std::size_t bits = 1; bits < next.size(); ++bits) next[bits] = (next[bits] + next[bits - 1]) << 1U;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (lengths[i] == 0) continue;
    unsigned code = next[lengths[i]]++, turned = 0;
    for (unsigned bit = 0; bit < lengths[i]; ++bit, code >>= 1U) turned = turned << 1U | (code & 1U);
    codes[i] = static_cast<std::uint16_t>(turned);
  }
}

}  // namespace adit::pack
