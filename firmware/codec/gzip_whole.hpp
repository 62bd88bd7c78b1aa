#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "icd/chunked_bytes.hpp"

namespace adit::codec {

/// Of libdeflate: 1 is the fastest. 6 is as small as zlib's 6 in a third of its time; from 10 on each level
/// is smaller than any of zlib's, and slow.
inline constexpr int kFastestLevel = 1, kSmallestLevel = 12;

/// One gzip member (RFC 1952) of bytes that are whole in memory, with nothing after it, and no time or name
/// in its header; nothing where it would take more than `most` bytes, which mostly shows before the end.
/// `level`: kFastestLevel to kSmallestLevel.
///
/// Takes at most `most` bytes of memory for the member, which is not copied, and for the while 1 MiB at
/// levels up to 9, 9 MiB above. What arrives in pieces is for Gzipper. CPU-bound in the size of `bytes`.
std::optional<icd::ChunkedBytes> gzip_whole(std::span<const std::uint8_t> bytes, int level, std::size_t most);

/// The `size` bytes of one gzip member with nothing after it, in a tenth of the time that gunzip() takes for
/// a grid; nothing where it is none, is damaged, or holds more or less. Takes as much memory, and as much as
/// the member where that is in several chunks.
std::optional<std::vector<std::uint8_t>> gunzip_whole(const icd::ChunkedBytes& member, std::size_t size);

}  // namespace adit::codec
