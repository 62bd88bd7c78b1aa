#pragma once

#include "codec/gzip.hpp"
#include "icd/mapping.hpp"

namespace adit::codec {

/// Passes a map's data, inflated if compressed, to `sink` in pieces of at most icd::ChunkedBytes::kChunk. An
/// error is about the data, or from `sink`.
icd::Checked<void> for_each_piece(const icd::MapData& data, const Sink& sink);

}  // namespace adit::codec
