#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "icd/chunked_bytes.hpp"

namespace adit::codec {

/// Levels of libdeflate; 1 is the fastest. 6 compresses like zlib's 6 in a third of the time. Levels from 10
/// on are smaller than any of zlib's, and slow.
inline constexpr int kFastestLevel = 1, kSmallestLevel = 12;

/// One gzip member (RFC 1952) of contiguous bytes, without time or name in its header. std::nullopt if it
/// would exceed `most` bytes, which mostly shows early. `level`: kFastestLevel to kSmallestLevel.
///
/// Takes at most `most` bytes for the member, which is not copied, and temporarily 1 MiB at levels up to 9, 9
/// MiB above. For data in pieces, use Gzipper. CPU time grows with the size of `bytes`.
std::optional<icd::ChunkedBytes> gzip_whole(std::span<const std::uint8_t> bytes, int level, std::size_t most);

/// The `size` bytes of exactly one gzip member, in a tenth of gunzip()'s time for a grid. std::nullopt if it
/// is invalid, damaged, or of another size. Takes `size` bytes of memory, and a copy of a member in several
/// chunks.
std::optional<std::vector<std::uint8_t>> gunzip_whole(const icd::ChunkedBytes& member, std::size_t size);

}  // namespace adit::codec
