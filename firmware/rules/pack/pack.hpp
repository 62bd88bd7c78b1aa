#pragma once

#include <cstddef>
#include <optional>

#include "icd/map_update.hpp"
#include "pack/effort.hpp"

namespace adit::pack {

/// The smallest form of a grid's cells: as stored, compressed by libdeflate at the level of `effort`, or
/// uncompressed. nullopt if the data is damaged. Uncompressed data, and any data with Effort::None, is
/// returned unchanged. Otherwise all cells are in memory meanwhile, with 1 MiB for libdeflate.
std::optional<icd::MapData> pack_cells(icd::MapData data, Effort effort);

/// How a cloud is made smaller.
struct CloudForm {
  bool is_arranged = true;       // its padding is dropped and its points are reordered
  double unit = 0;               // metres; if it is arranged, coordinates are rounded to this; 0: no rounding
  Effort effort = Effort::Full;  // with another effort, nothing is rounded
};
/// The units in use.
inline constexpr double kMillimetre = 0x1p-10, kEightMillimetres = 0x1p-7;

/// Makes an uncompressed cloud as small as `form` allows, ready to be written. Points that are not finite are
/// dropped, because clouds are dense (ICD 6.3.2). Otherwise only rounding loses anything; it changes the
/// cloud's origin (rounding.hpp). The points are gzipped if that makes them smaller; if not, they keep their
/// order. A compressed cloud is returned unchanged. Takes memory of up to twice the cloud's size, or three
/// times if points are dropped, and time by its size, so call it on a worker.
icd::MapUpdate pack(icd::MapUpdate map, const CloudForm& form = {});

/// `data` without the points whose x, y or z is not finite. `data` must be uncompressed.
icd::MapData without_invalid_points(const icd::PointCloud2& cloud, icd::MapData data);

/// True if `map` is a non-empty, uncompressed cloud without any finite point. Reads up to the first finite
/// point, so the time grows with the size only if there is none.
bool has_only_invalid_points(const icd::MapUpdate& map);

}  // namespace adit::pack
