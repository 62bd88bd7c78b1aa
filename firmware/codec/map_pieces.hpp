#pragma once

#include "codec/gzip.hpp"
#include "icd/map_update.hpp"

namespace adit::codec {

/// Gives a map's data to `sink`, inflated where it is compressed, in pieces of up to
/// icd::ChunkedBytes::kChunk; the error says what is wrong with it, or is the sink's.
icd::Checked<void> for_each_piece(const icd::MapData& data, const Sink& sink);

}  // namespace adit::codec
