#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "icd/mapping.hpp"

namespace adit::pack {

/// How hard a map is compressed.
enum class Effort : std::uint8_t {
  None,   // points unchanged, without those that are not finite; cells as stored
  Quick,  // points without padding, in their order, at gzip's fastest level; cells at kQuickCellsLevel
  Full,   // points as CloudForm says; cells at kCellsLevel
};

/// The conditions that decide the effort for a map.
struct EffortInput {
  double bytes_per_second = 1;  // the rate of its link
  double slowness = 1;          // of this box: a factor for seconds_for()
  double longest = 1;           // seconds from one map to the next
};

/// Seconds per byte of each effort, and Full's size relative to Quick's: tests/bench/sizes, exact clouds.
inline constexpr double kSecondsPerByte[] = {0, 7e-9, 15e-9};
inline constexpr double kFullOfQuick = 0.85;

/// Larger maps are not packed (Effort::None), as packing holds one up to twice in memory beside its file.
inline constexpr std::size_t kMostPacked = std::size_t{40} << 20;

/// libdeflate's levels for cells. The next higher level takes 9 MiB of memory; a lower one is hardly faster.
inline constexpr int kCellsLevel = 9, kQuickCellsLevel = 2;

/// The effort for a map, and the size to which Full compresses a byte of its points.
struct Choice {
  Effort effort = Effort::Full;
  double full_to = 1;
};

/// The effort for a cloud of `size` bytes, if Quick compresses a byte to `quick_to`. A worker packs one cloud
/// while the link carries another: the slower of the two, if it takes longer than `longest`, delays all maps,
/// and the effort with the shortest delay is chosen. Among several, it is the effort with which the cloud is
/// sent completely first. Another effort than Full must save a tenth of that time.
Effort effort_for(std::size_t size, double quick_to, const EffortInput& hurry);

/// The same for an exact, uncompressed cloud, or None for more than kMostPacked. Compresses a sample if the
/// result can matter; otherwise `full_to` is 1.
///
/// For a stored grid: the greatest effort that takes at most half of `longest`, half a second, and the time
/// in which the grid as stored is sent. None for more than kMostPacked. Also None for more than 16 MiB of
/// cells if the stored form has at most one byte per 40 cells.
Choice effort_for(const icd::MapUpdate& map, const EffortInput& hurry);

/// Seconds to pack `map` (uncompressed points or stored cells) on the box of tests/bench/README.md: typical
/// for a cloud, the maximum for a grid.
double seconds_for(Effort effort, const icd::MapUpdate& map);

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
/// cloud's origin (arrange.hpp). The points are gzipped if that makes them smaller; if not, they keep their
/// order. A compressed cloud is returned unchanged. Takes memory of up to twice the cloud's size, or three
/// times if points are dropped, and time by its size, so call it on a worker.
icd::MapUpdate pack(icd::MapUpdate map, const CloudForm& form = {});

/// `data` without the points whose x, y or z is not finite. `data` must be uncompressed.
icd::MapData remove_invalid_points(const icd::PointCloud2& cloud, icd::MapData data);

/// True if `map` is a non-empty, uncompressed cloud without any finite point. Reads up to the first finite
/// point, so the time grows with the size only if there is none.
bool has_only_invalid_points(const icd::MapUpdate& map);

}  // namespace adit::pack
