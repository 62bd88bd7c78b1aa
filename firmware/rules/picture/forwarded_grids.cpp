#include "picture/forwarded_grids.hpp"

#include <algorithm>
#include <array>
#include <ranges>
#include <utility>

#include "codec/gzip.hpp"
#include "icd/geometry.hpp"

namespace adit::picture {
namespace {

/// The largest relative error of a float32 from a robot's software.
constexpr double kRounding = 1e-3;

std::array<icd::Point, 4> corners_of(const icd::OccupancyGrid& grid) {
  const icd::Placement placement{grid.origin};
  const double along = grid.width * grid.resolution, up = grid.height * grid.resolution;
  return {placement({0, 0, 0}), placement({along, 0, 0}), placement({0, up, 0}), placement({along, up, 0})};
}

Area area_of(const icd::OccupancyGrid& grid) {
  const auto corners = corners_of(grid);
  const auto [left, right] = std::ranges::minmax(corners, {}, &icd::Point::x);
  const auto [bottom, top] = std::ranges::minmax(corners, {}, &icd::Point::y);
  return {left.x, bottom.y, right.x, top.y};
}

bool is_same(const ForwardedGrid& a, const ForwardedGrid& b) {
  return a.grid.resolution == b.grid.resolution && a.grid.width == b.grid.width &&
         a.grid.height == b.grid.height && a.grid.origin == b.grid.origin && a.data == b.data;
}

/// Copies into pieces of their own, because a shared piece would keep a larger buffer alive.
icd::ChunkedBytes copy_bytes(const icd::ChunkedBytes& bytes) {
  icd::ChunkedBytes copy;
  for (const icd::Chunk& chunk : bytes.chunks()) {
    for (auto rest = *chunk; !rest.empty();) {
      const auto piece = rest.first(std::min(rest.size(), icd::ChunkedBytes::kChunk));
      copy.append(std::vector<std::uint8_t>(piece.begin(), piece.end()));
      rest = rest.subspan(piece.size());
    }
  }
  return copy;
}

icd::MapData pack_data(const icd::MapData& data) {
  const bool is_packed = data.compression == icd::Compression::Gzip;
  if (is_packed && data.bytes.size() > kLargestFineGrid) return {};
  auto bytes = is_packed ? copy_bytes(data.bytes) : codec::gzip(data.bytes, codec::GzipStrategy::Runs);
  if (bytes.size() > kLargestFineGrid) return {};
  return {std::move(bytes), icd::Compression::Gzip, data.raw_size};
}

}  // namespace

std::size_t ForwardedGrid::cost() const {
  constexpr std::size_t kAllocations = 256;
  return sizeof(ForwardedGrid) + kAllocations + data.bytes.size() +
         data.bytes.chunks().size() * sizeof(icd::Chunk);
}

std::shared_ptr<const ForwardedGrid> forwarded_grid(const icd::MapUpdate& map) {
  const auto* grid = std::get_if<icd::OccupancyGrid>(&map.msg);
  if (grid == nullptr) return nullptr;
  return std::make_shared<const ForwardedGrid>(
      ForwardedGrid{.layer = layer_of(map),
                    .grid = *grid,
                    .data = grid->resolution > kLargestFineCell ? icd::MapData{} : pack_data(map.data),
                    .area = area_of(*grid)});
}

bool ForwardedGrids::add(std::shared_ptr<const ForwardedGrid> grid, std::uint64_t number) {
  const auto found = layers_.find(grid->layer);
  if (grid->data.bytes.empty()) {
    if (found == layers_.end()) return false;
    forget(found->second, found->second.begin(), found->second.end());
    layers_.erase(found);
    return true;
  }
  const bool is_finer = grid->grid.resolution < kPixel * (1 - kRounding);
  if (found == layers_.end() && !is_finer) return false;
  Grids& kept = layers_[grid->layer];
  if (!kept.empty() && is_same(*kept.back().grid, *grid)) return false;
  const auto covered = std::ranges::stable_partition(
      kept, [&](const GridEntry& older) { return !icd::covers(grid->grid, older.bounds); });
  auto bounds = icd::GridBounds::from_grid(grid->grid);
  for (const GridEntry& older : covered) bounds = icd::joint_bounds(bounds, older.bounds);
  forget(kept, covered.begin(), covered.end());
  bytes_ += grid->cost();
  kept.push_back({std::move(grid), number, bounds});
  keep_to_budget();
  return true;
}

void ForwardedGrids::clear() {
  layers_.clear();
  bytes_ = 0;
}

void ForwardedGrids::forget(Grids& grids, Grids::iterator first, Grids::iterator end) {
  for (auto each = first; each != end; ++each) bytes_ -= each->grid->cost();
  grids.erase(first, end);
}

void ForwardedGrids::keep_to_budget() {
  while (bytes_ > budget_) {
    const auto oldest =
        std::ranges::min_element(layers_, {}, [](const auto& layer) { return layer.second.front().number; });
    Grids& grids = oldest->second;
    forget(grids, grids.begin(), grids.begin() + 1);
    if (grids.empty()) layers_.erase(oldest);
  }
}

std::vector<std::shared_ptr<const ForwardedGrid>> ForwardedGrids::grids_in(const Layer& layer,
                                                                           const Area& area) const {
  std::vector<std::shared_ptr<const ForwardedGrid>> grids;
  const auto found = layers_.find(layer);
  if (found == layers_.end()) return grids;
  std::size_t cells = 0;
  for (const GridEntry& kept : std::views::reverse(found->second)) {
    if (!touch(kept.grid->area, area)) continue;
    cells += kept.grid->data.raw_size;
    if (cells > kMostCells && !grids.empty()) break;
    grids.push_back(kept.grid);
  }
  std::ranges::reverse(grids);
  return grids;
}

std::uint64_t ForwardedGrids::newest_in(const Layer& layer, const Area& area) const {
  const auto found = layers_.find(layer);
  if (found == layers_.end()) return 0;
  std::uint64_t newest = 0;
  for (const GridEntry& kept : found->second) {
    if (touch(kept.grid->area, area)) newest = kept.number;
  }
  return newest;
}

std::optional<FinerLevels> ForwardedGrids::finer_levels(const Layer& layer, std::uint64_t since) const {
  const auto found = layers_.find(layer);
  if (found == layers_.end()) return std::nullopt;
  FinerLevels finer{.version = found->second.back().number, .area = {}};
  double smallest = kPixel;
  for (const GridEntry& kept : found->second) {
    smallest = std::min(smallest, kept.grid->grid.resolution);
    if (kept.number > since) extend(finer.area, kept.grid->area);
  }
  while (finer.level > kFinest && smallest < metres_per_pixel(finer.level) * (1 - kRounding)) --finer.level;
  return finer.level < 0 ? std::optional(finer) : std::nullopt;
}

}  // namespace adit::picture
