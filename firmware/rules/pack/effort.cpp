#include "pack/effort.hpp"

#include <algorithm>
#include <compare>
#include <span>
#include <utility>
#include <vector>

#include "codec/gzip_whole.hpp"

namespace adit::pack {
namespace {

/// Another effort may take at most this part of the time.
constexpr double kWorthIt = 0.9;

double seconds_per_byte(Effort effort) {
  return kSecondsPerByte[static_cast<std::size_t>(effort)];
}

/// Appends `size` bytes from `at` on.
void append(std::vector<std::uint8_t>& to, const icd::ChunkedBytes& bytes, std::size_t at, std::size_t size) {
  for (const auto& chunk : bytes.chunks()) {
    const std::size_t before = std::min(at, chunk->size());
    const auto some = chunk->subspan(before, std::min(size, chunk->size() - before));
    to.insert(to.end(), some.begin(), some.end());
    at -= before;
    size -= some.size();
    if (size == 0) return;
  }
}

/// The size to which Quick compresses a byte, measured on a sample of the points.
double tried(const icd::ChunkedBytes& points) {
  constexpr std::size_t kShare = 32, kTelling = std::size_t{64} << 10, kStretches = 16;
  const std::size_t size = std::min(points.size(), std::max(points.size() / kShare, kTelling));
  std::vector<std::uint8_t> some;
  some.reserve(size);
  for (std::size_t i = 0; i < kStretches; ++i) {
    append(some, points, points.size() / kStretches * i, size / kStretches);
  }
  if (some.empty()) return 1;
  const auto member = codec::gzip_whole(some, codec::kFastestLevel, some.size());
  return member ? static_cast<double>(member->size()) / static_cast<double>(some.size()) : 1;
}

/// True if the cells are not worth their memory. Measured: a byte of a stored cave holds 35 to 220 cells, but
/// only 2 to 20 if libdeflate can make it much smaller.
bool is_left(const icd::MapData& cells) {
  constexpr std::size_t kMany = std::size_t{16} << 20, kPerByte = 40;
  return cells.raw_size > kMany && cells.bytes.size() <= cells.raw_size / kPerByte;
}

Effort for_cells(const icd::MapUpdate& grid, const Hurry& hurry) {
  if (is_left(grid.data)) return Effort::None;
  const double as_stored = static_cast<double>(grid.data.bytes.size()) / hurry.bytes_per_second;
  const double most = std::min({hurry.longest / 2, 0.5, as_stored});
  for (const Effort effort : {Effort::Full, Effort::Quick}) {
    if (hurry.slowness * seconds_for(effort, grid) <= most) return effort;
  }
  return Effort::None;
}

}  // namespace

Effort effort_for(std::size_t size, double quick_to, const Hurry& hurry) {
  const double bytes = static_cast<double>(size);
  struct Cost {
    double delay, takes;  // seconds, of all maps and of this one
    auto operator<=>(const Cost&) const = default;
  };
  const auto cost = [&](Effort effort, double to) -> Cost {
    const double packs = hurry.slowness * seconds_per_byte(effort) * bytes;
    const double leaves = to * bytes / hurry.bytes_per_second;
    return {std::max({packs, leaves, hurry.longest}), packs + leaves};
  };
  Cost least = cost(Effort::Full, quick_to * kFullOfQuick);
  least.takes *= kWorthIt;
  Effort best = Effort::Full;
  for (const auto& [effort, to] : {std::pair{Effort::Quick, quick_to}, std::pair{Effort::None, 1.0}}) {
    const Cost other = cost(effort, to);
    if (other > least) continue;
    least = other;
    best = effort;
  }
  return best;
}

/// If even a cloud that Quick shrinks to nothing is best sent uncompressed, no sample is tried.
Choice effort_for(const icd::MapUpdate& map, const Hurry& hurry) {
  if (map.data.raw_size > kMostPacked) return {Effort::None};
  if (map.is_grid()) return {for_cells(map, hurry)};
  const std::size_t size = map.data.bytes.size();
  if (effort_for(size, 0, hurry) == Effort::None) return {Effort::None};
  const double quick_to = tried(map.data.bytes);
  return {effort_for(size, quick_to, hurry), quick_to * kFullOfQuick};
}

/// Measured: the maximum over all grids. A high level takes its time for the bytes of the stored form.
double seconds_for(Effort effort, const icd::MapUpdate& map) {
  const double size = static_cast<double>(map.data.raw_size);
  if (!map.is_grid()) return seconds_per_byte(effort) * size;
  constexpr double kQuickPerCell = 17e-9, kFullPerCell = 5e-9, kFullPerKeptByte = 2.5e-6;
  if (effort == Effort::None) return 0;
  if (effort == Effort::Quick) return kQuickPerCell * size;
  return kFullPerCell * size + kFullPerKeptByte * static_cast<double>(map.data.bytes.size());
}

}  // namespace adit::pack
