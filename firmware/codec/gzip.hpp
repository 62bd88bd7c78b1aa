#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "icd/chunked_bytes.hpp"
#include "icd/status.hpp"

namespace adit::codec {

enum class GzipStrategy : std::uint8_t {
  Default,  // zlib level 6: for point clouds
  Runs,     // zlib level 6 with Z_RLE: for grids, two to five times faster and mostly smaller
};

/// One gzip member (RFC 1952) with nothing after it. `bytes` is consumed chunk by chunk.
icd::ChunkedBytes gzip(icd::ChunkedBytes bytes, GzipStrategy strategy);

/// Inflates exactly one gzip member, giving each piece of output to `sink` (which may refuse), consuming
/// `bytes`. Refuses, with 422 about the field at `path`: what is no gzip, is cut short, has a bad checksum,
/// has anything after its end, or grows over `most` bytes.
icd::Checked<std::size_t> gunzip(
    icd::ChunkedBytes bytes, std::size_t most, std::string_view path,
    const std::function<icd::Checked<void>(std::span<const std::uint8_t>)>& sink);

}  // namespace adit::codec
