#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/chunked_bytes.hpp"
#include "pack/bit_writer.hpp"
#include "pack/cheapest_tokens.hpp"
#include "pack/deflate_block.hpp"

namespace adit::pack {

/// Makes one gzip member (RFC 1952) of a grid's cells, which it is fed row by row, with nothing after it, and
/// no time or name in its header. It looks for the same cells beside, below, and below to either side alone:
/// there grids repeat themselves. So it is smaller than zlib at its best on most of them and takes less than
/// half of zlib's usual time; where a grid has patterns that repeat elsewhere, it is larger.
///
/// It holds 0.4 MiB besides what it has made, whatever the size of the grid.
class GridGzipper {
 public:
  /// `width`: cells in a row, at least 1. Rows longer than DEFLATE's window of 32 KiB are compared with
  /// nothing.
  explicit GridGzipper(std::size_t width);
  GridGzipper(const GridGzipper&) = delete;
  GridGzipper& operator=(const GridGzipper&) = delete;

  void feed(std::span<const std::uint8_t> cells);
  /// The whole member, once, after the last feed.
  icd::ChunkedBytes finish();

 private:
  void make_room();
  void encode(bool to_the_end);
  void learn();
  void end_block(bool is_last);

  icd::ChunkedBytes member_;
  BitWriter out_{member_};
  std::vector<std::uint8_t> cells_;  // the window before, and what came
  std::size_t first_, next_, end_;   // of cells_: what there is, what has no token yet
  CheapestTokens cheapest_;
  TokenCosts costs_;
  std::vector<Token> tokens_;  // of a block
  std::size_t learned_ = 0;    // of these
  SymbolCounts counts_;
  std::uint32_t crc_ = 0, size_ = 0;
};

}  // namespace adit::pack
