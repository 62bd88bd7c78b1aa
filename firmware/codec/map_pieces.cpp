#include "codec/map_pieces.hpp"

#include <utility>

namespace adit::codec {

icd::Checked<void> for_each_piece(const icd::MapData& data, const Sink& sink) {
  if (data.compression == icd::Compression::None) {
    for (const auto& chunk : data.bytes.chunks()) {
      if (auto taken = sink(*chunk); !taken) return taken;
    }
    return {};
  }
  auto inflated = gunzip(data.bytes, data.raw_size, "msg.data", sink);
  if (!inflated) return std::unexpected(std::move(inflated.error()));
  return {};
}

}  // namespace adit::codec
