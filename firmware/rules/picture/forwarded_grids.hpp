#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "icd/grid_bounds.hpp"
#include "picture/mosaic.hpp"

namespace adit::picture {

/// A grid that the Command Post accepted. It owns its bytes.
struct ForwardedGrid {
  Layer layer;
  icd::OccupancyGrid grid;
  icd::MapData data;  // gzipped; empty: not kept
  Area area;          // its bounding box

  std::size_t cost() const;  // approximate memory
};

/// Null if `map` is a cloud. May have to compress the map, so call it on a worker.
std::shared_ptr<const ForwardedGrid> forwarded_grid(const icd::MapUpdate& map);

/// A grid's data is not kept if its cells are larger than this, or if it takes more bytes.
inline constexpr double kLargestFineCell = 0.5;  // metres
inline constexpr std::size_t kLargestFineGrid = std::size_t{4} << 20;

/// The last grids of each robot as they were forwarded. Finer tiles are drawn from them. A new grid replaces
/// the grids that it covers (icd::covers()). A grid without data replaces all grids of its layer. So the
/// newest forwarded grid is always shown. Keeps at most `budget` bytes and drops the oldest grids first.
class ForwardedGrids {
 public:
  static constexpr std::size_t kBudget = std::size_t{16} << 20;
  /// The most cells to draw for one block of tiles: about a second of work on a small board.
  static constexpr std::size_t kMostCells = std::size_t{256} << 20;

  explicit ForwardedGrids(std::size_t budget = kBudget) : budget_(budget) {}

  /// `number` must be greater than all before. False if no finer tile can change because of this grid.
  bool add(std::shared_ptr<const ForwardedGrid> grid, std::uint64_t number);
  void clear();

  /// The last grids that touch `area`, oldest first, with at most kMostCells together, but always one.
  std::vector<std::shared_ptr<const ForwardedGrid>> grids_in(const Layer& layer, const Area& area) const;
  /// The number of the newest grid that touches `area`; 0: no grid.
  std::uint64_t newest_in(const Layer& layer, const Area& area) const;
  /// A layer's finest level, and the area that changed after `since`. nullopt: not finer than the mosaic.
  std::optional<FinerLevels> finer_levels(const Layer& layer, std::uint64_t since) const;
  std::size_t bytes() const { return bytes_; }

 private:
  struct GridEntry {
    std::shared_ptr<const ForwardedGrid> grid;
    std::uint64_t number = 0;
    icd::GridBounds bounds;  // of it and of all that it replaced
  };
  using Grids = std::vector<GridEntry>;  // oldest first; never empty
  void forget(Grids& grids, Grids::iterator first, Grids::iterator end);
  void keep_to_budget();

  std::size_t budget_, bytes_ = 0;
  std::map<Layer, Grids> layers_;
};

}  // namespace adit::picture
