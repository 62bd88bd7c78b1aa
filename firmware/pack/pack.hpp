#pragma once

#include <cstddef>

#include "icd/map_update.hpp"
#include "pack/effort.hpp"

namespace adit::pack {

/// What is done to a cloud so that it becomes smaller.
struct CloudForm {
  bool is_arranged = true;  // its padding is dropped, and its points are put in another order
  double unit = 0;          // metres, to which coordinates are rounded where it is arranged; 0: they are not
  Effort effort = Effort::Full;  // if they are not rounded
};
/// Units that there are.
inline constexpr double kMillimetre = 0x1p-10, kEightMillimetres = 0x1p-7;

/// A cloud as small as it can be made without loss but what `form` allows, ready to be written: it loses
/// the points that are not finite (ICD 6.3.2 takes clouds to be dense) and takes `form`: it was rounded where
/// its origin is another (rounding.hpp), and if it is not compressed yet it is gzipped
/// where that is smaller; where it is not, points stay in their order. CPU-bound in the size of the cloud,
/// and takes as much memory as that and half as much more: meant for a worker.
icd::MapUpdate pack(icd::MapUpdate map, const CloudForm& form = {});

/// `data` without the points whose x, y or z is not finite. `data` must be uncompressed.
icd::MapData without_invalid_points(const icd::PointCloud2& cloud, icd::MapData data);

/// Whether `map` is a cloud of which nothing would be left then, though it has points. CPU-bound in the size
/// of such a cloud; of any other its first points tell.
bool has_only_invalid_points(const icd::MapUpdate& map);

}  // namespace adit::pack
