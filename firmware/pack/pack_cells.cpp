#include "pack/pack_cells.hpp"

#include <algorithm>
#include <utility>

#include "codec/gzip_whole.hpp"

namespace adit::pack {
std::optional<icd::MapData> pack_cells(icd::MapData data, Effort effort) {
  if (effort == Effort::None || data.compression == icd::Compression::None) return data;
  const auto cells = codec::gunzip_whole(data.bytes, data.raw_size);
  if (!cells) return std::nullopt;
  const int level = effort == Effort::Full ? kCellsLevel : kQuickCellsLevel;
  const std::size_t smallest = std::min(cells->size(), data.bytes.size());
  if (auto member = codec::gzip_whole(*cells, level, smallest - 1)) {
    data.bytes = *std::move(member);
  } else if (smallest == cells->size()) {
    return icd::MapData{icd::ChunkedBytes(*cells), icd::Compression::None, cells->size()};
  }
  return data;
}

}  // namespace adit::pack
