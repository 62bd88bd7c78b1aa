#include "codec/map_pieces.hpp"

#include <algorithm>

#include "icd/try.hpp"

namespace adit::codec {
namespace {

icd::Checked<void> give_pieces(std::span<const std::uint8_t> bytes, const Sink& sink) {
  while (!bytes.empty()) {
    const auto piece = bytes.first(std::min(bytes.size(), icd::ChunkedBytes::kChunk));
    if (auto taken = sink(piece); !taken) return taken;
    bytes = bytes.subspan(piece.size());
  }
  return {};
}

}  // namespace

icd::Checked<void> for_each_piece(const icd::MapData& data, const Sink& sink) {
  if (data.compression == icd::Compression::None) {
    for (const auto& chunk : data.bytes.chunks()) {
      if (auto taken = give_pieces(*chunk, sink); !taken) return taken;
    }
    return {};
  }
  ADIT_TRY(gunzip(data.bytes, data.raw_size, "msg.data", sink));
  return {};
}

}  // namespace adit::codec
