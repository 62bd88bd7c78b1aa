#pragma once

#include <cstdint>
#include <span>

namespace adit::pack {

/// The best lengths that a prefix code of at most `most_bits` a symbol can have (package-merge), for symbols
/// that occur so often; 0 for those that do not. A symbol that is alone gets one bit, as DEFLATE wants it
/// (RFC 1951 3.2.7). `lengths` has as many places as `counts`, and 2^most_bits is not less.
void code_lengths(std::span<const std::uint32_t> counts, int most_bits, std::span<std::uint8_t> lengths);

/// The codes of these lengths (RFC 1951 3.2.2), their first bit lowest, as they are written.
void codes_of(std::span<const std::uint8_t> lengths, std::span<std::uint16_t> codes);

}  // namespace adit::pack
