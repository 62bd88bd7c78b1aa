#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pack/bit_writer.hpp"
#include "pack/deflate_symbols.hpp"

namespace adit::pack {

/// How often each symbol occurs.
struct SymbolCounts {
  std::array<std::uint32_t, kLetters> letters{};
  std::array<std::uint32_t, kDistances> distances{};

  void add(std::span<const Token> tokens);
};

/// Bits of each symbol's code; 0 for those without one.
struct SymbolLengths {
  std::array<std::uint8_t, kLetters> letters{};
  std::array<std::uint8_t, kDistances> distances{};
};

/// The best ones for a block with these symbols and its end.
SymbolLengths lengths_for(SymbolCounts counts);

/// A block with a code of its own (RFC 1951 3.2.7). `counts`: those of its tokens.
void write_block(BitWriter& out, std::span<const Token> tokens, const SymbolCounts& counts, bool is_last);

}  // namespace adit::pack
