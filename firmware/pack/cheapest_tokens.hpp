#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pack/deflate_block.hpp"
#include "pack/deflate_symbols.hpp"
#include "pack/same_as_before.hpp"

namespace adit::pack {

/// What tokens cost, in bits.
class TokenCosts {
 public:
  /// As in most grids, before anything is known of this one.
  TokenCosts();
  /// By the codes of a block; what has no code costs a bit more than all that has.
  explicit TokenCosts(const SymbolLengths& lengths);

  std::uint32_t of_byte(std::uint8_t byte) const { return bytes_[byte]; }
  std::uint32_t of_length(std::size_t length) const { return lengths_[length]; }
  std::uint32_t of_distance(std::size_t distance) const;

 private:
  std::array<std::uint8_t, 256> bytes_{};
  std::array<std::uint8_t, kMostCopy + 1> lengths_{};
  std::array<std::uint8_t, kDistances> distances_{};
};

/// Finds the cheapest tokens for cells, with copies from a few distances alone.
///
/// It is the shortest way through a graph: places between cells are its nodes, and tokens its edges. Only
/// those edges are looked at that can be part of it: the longest copy of each distance, and a byte where a
/// copy ends or none begins. So most cells are never looked at one by one.
class CheapestTokens {
 public:
  /// `distances`: at most kMostDistances of them, the nearest first.
  static constexpr std::size_t kMostDistances = 8;
  explicit CheapestTokens(std::vector<std::size_t> distances) : distances_(std::move(distances)) {}

  /// A stretch has at most so many cells, and what is found for it goes on by less than a copy.
  static constexpr std::size_t kMostCells = 8192;

  /// Where cells lie in memory: `first` to `end` are there, and SameAsBefore can read beyond.
  struct Cells {
    const std::uint8_t* bytes;
    std::size_t first, end;
  };
  /// Adds the tokens for the cells from `begin` to `end`, or to where the last copy ends behind it, and
  /// returns that.
  std::size_t find(Cells cells, std::size_t begin, std::size_t end, const TokenCosts& costs,
                   std::vector<Token>& tokens);

 private:
  /// A way to a node: its cost, and the last token on it. The lesser one is the cheaper one.
  using Way = std::uint32_t;
  static constexpr Way kNone = UINT32_MAX;

  void begin_at(Cells cells, std::size_t begin, const TokenCosts& costs);
  void look_from(std::size_t node, std::size_t end);
  void reach(std::size_t node, Way way);
  std::size_t last_node(std::size_t from) const;
  void trace(std::size_t node, std::vector<Token>& tokens) const;

  std::vector<std::size_t> distances_;
  std::vector<SameAsBefore> same_;
  std::array<Way, kMostDistances> distance_costs_{};
  std::array<Way, kMostCopy + 1> length_costs_{};
  const TokenCosts* costs_ = nullptr;
  Cells cells_{};
  std::size_t begin_ = 0;
  std::vector<Way> ways_;               // to each node from begin_ on
  std::vector<std::uint64_t> reached_;  // a bit for each
  std::size_t ahead_ = 0;               // the node beyond which nothing is cheaper
  Way ahead_cost_ = kNone;
};

}  // namespace adit::pack
