#include "pack/cheapest_tokens.hpp"

#include <algorithm>
#include <bit>

#include "icd/require.hpp"

namespace adit::pack {
namespace {

/// A way is its cost, the number of the last copy's distance, and its length; 1 for a byte.
constexpr unsigned kLengthBits = 9, kDistanceBits = 3, kCostShift = kLengthBits + kDistanceBits;
constexpr std::uint32_t kLengthMask = (1U << kLengthBits) - 1, kDistanceMask = (1U << kDistanceBits) - 1;
constexpr std::uint32_t kCostMask = ~((1U << kCostShift) - 1);
constexpr std::uint32_t kNever = 0x80000;  // above all that a stretch can cost
constexpr std::size_t kWord = 64;

std::uint8_t most_of(std::span<const std::uint8_t> lengths) {
  constexpr std::uint8_t kMost = 14, kLeast = 6;
  return std::clamp(std::ranges::max(lengths), kLeast, kMost);
}

}  // namespace

TokenCosts::TokenCosts() {
  bytes_.fill(6);
  for (unsigned length = kLeastCopy; length <= kMostCopy; ++length) {
    lengths_[length] = static_cast<std::uint8_t>(5 + kLengthSymbols[length].extra_bits);
  }
  lengths_[kMostCopy] = 3;
  for (unsigned i = 0; i < kDistances; ++i)
    distances_[i] = static_cast<std::uint8_t>(2 + (i < 4 ? 0 : i / 2 - 1));
  distances_[0] = 1;
}

TokenCosts::TokenCosts(const SymbolLengths& lengths) {
  const auto letter = [&, none = most_of(lengths.letters) + 1](std::size_t symbol) {
    return lengths.letters[symbol] == 0 ? none : lengths.letters[symbol];
  };
  for (std::size_t i = 0; i < bytes_.size(); ++i) bytes_[i] = static_cast<std::uint8_t>(letter(i));
  for (std::size_t i = kLeastCopy; i <= kMostCopy; ++i) {
    lengths_[i] = static_cast<std::uint8_t>(letter(kLengthSymbols[i].symbol) + kLengthSymbols[i].extra_bits);
  }
  const int none = std::max<int>(std::ranges::max(lengths.distances), 3) + 1;
  for (unsigned i = 0; i < kDistances; ++i) {
    const int bits = lengths.distances[i] == 0 ? none : lengths.distances[i];
    distances_[i] = static_cast<std::uint8_t>(bits + (i < 4 ? 0 : static_cast<int>(i) / 2 - 1));
  }
}

std::uint32_t TokenCosts::of_distance(std::size_t distance) const {
  return distances_[symbol_of_distance(static_cast<unsigned>(distance - 1)).symbol];
}

void CheapestTokens::begin_at(Cells cells, std::size_t begin, const TokenCosts& costs) {
  cells_ = cells;
  begin_ = begin;
  costs_ = &costs;
  same_.clear();
  for (std::size_t i = 0; i < distances_.size(); ++i) {
    same_.emplace_back(cells.bytes, cells.first, distances_[i]);
    distance_costs_[i] = costs.of_distance(distances_[i]) << kCostShift | static_cast<Way>(i) << kLengthBits;
  }
  length_costs_.fill(kNever << kCostShift);
  for (Way length = kLeastCopy; length <= kMostCopy; ++length) {
    length_costs_[length] = costs.of_length(length) << kCostShift | length;
  }
  ways_.assign(kMostCells + kMostCopy, kNone);
  reached_.assign((kMostCells + kMostCopy) / kWord + 1, 0);
  ahead_ = 0;
  reach(0, 0);
}

inline void CheapestTokens::reach(std::size_t node, Way way) {
  ways_[node] = std::min(ways_[node], way);
  reached_[node / kWord] |= std::uint64_t{1} << node % kWord;
}

/// The edges that begin at a node.
inline void CheapestTokens::look_from(std::size_t node, std::size_t end) {
  const Way cost = ways_[node] & kCostMask;
  if (ahead_ <= node) ahead_cost_ = kNone;
  if (ahead_cost_ <= cost && node > 0) return;  // what begins here is no cheaper from there
  const std::size_t place = begin_ + node, most = std::min(kMostCopy, cells_.end - place);
  bool is_end = false;
  std::size_t longest = 0;
  Way* const ways = ways_.data() + node;
  std::uint64_t* const reached = reached_.data();
  const Way* distance_cost = distance_costs_.data();
  for (SameAsBefore& same : same_) {
    const std::size_t length = std::min(same.until(place, end) - place, most);
    const Way way = cost + length_costs_.data()[length] + *distance_cost++;
    const std::size_t to = node + length;
    const bool is_copy = length >= kLeastCopy;
    ways[length] = std::min(ways[length], way);
    reached[to / kWord] |= std::uint64_t{is_copy} << to % kWord;
    const bool is_cheaper = is_copy && (way & kCostMask) <= ahead_cost_;
    ahead_cost_ = is_cheaper ? way & kCostMask : ahead_cost_;
    ahead_ = is_cheaper ? to : ahead_;
    is_end |= length == 0;
    longest = std::max(longest, length);
    if (length == kMostCopy) break;  // none goes further, and the nearest is the cheapest
  }
  if (!is_end && longest >= kLeastCopy) return;
  reach(node + 1, cost + (costs_->of_byte(cells_.bytes[place]) << kCostShift) + 1);
}

/// The cheapest one from `from` on, the last of them.
std::size_t CheapestTokens::last_node(std::size_t from) const {
  std::size_t best = from;
  for (std::size_t word = from / kWord; word < reached_.size(); ++word) {
    for (std::uint64_t left = reached_[word]; left != 0; left &= left - 1) {
      const std::size_t node = word * kWord + static_cast<std::size_t>(std::countr_zero(left));
      if (node >= from && (ways_[node] & kCostMask) <= (ways_[best] & kCostMask)) best = node;
    }
  }
  return best;
}

void CheapestTokens::trace(std::size_t node, std::vector<Token>& tokens) const {
  const std::size_t count = tokens.size();
  while (node > 0) {
    const Way way = ways_[node];
    const auto length = static_cast<std::uint16_t>(way & kLengthMask);
    node -= length;
    if (length == 1) {
      tokens.push_back({0, cells_.bytes[begin_ + node]});
    } else {
      const std::size_t distance = distances_[way >> kLengthBits & kDistanceMask];
      tokens.push_back({length, static_cast<std::uint16_t>(distance - 1)});
    }
  }
  std::reverse(tokens.begin() + static_cast<std::ptrdiff_t>(count), tokens.end());
}

std::size_t CheapestTokens::find(Cells cells, std::size_t begin, std::size_t end, const TokenCosts& costs,
                                 std::vector<Token>& tokens) {
  icd::require(begin < end && end - begin <= kMostCells && end <= cells.end);
  begin_at(cells, begin, costs);
  const std::size_t nodes = end - begin, seen = std::min(end + kMostCopy, cells.end);
  for (std::size_t word = 0; word * kWord < nodes; ++word) {
    std::uint64_t done = 0;
    while (const std::uint64_t left = reached_[word] & ~done) {
      done |= left & -left;
      const std::size_t node = word * kWord + static_cast<std::size_t>(std::countr_zero(left));
      if (node >= nodes) break;
      look_from(node, seen);
    }
  }
  const std::size_t last = last_node(nodes);
  trace(last, tokens);
  return begin + last;
}

}  // namespace adit::pack
