#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "picture/mosaic.hpp"

namespace adit::picture {

/// A grid as the Command Post took it, with bytes of its own.
struct ForwardedGrid {
  Layer layer;
  icd::OccupancyGrid grid;
  icd::MapData data;  // under gzip; none: it is not kept
  Area area;          // that it lies in

  std::size_t cost() const;  // in memory, nearly
};

/// Null where it is a cloud. CPU-bound in the size of the map, though most are packed already: for a worker.
std::shared_ptr<const ForwardedGrid> forwarded_grid(const icd::MapUpdate& map);

/// Its cells are not looked at finer than the mosaic has them if they are larger; it is not kept if it takes
/// more bytes.
inline constexpr double kLargestFineCell = 0.5;  // metres
inline constexpr std::size_t kLargestFineGrid = std::size_t{4} << 20;

/// The last grids of each robot as they were forwarded, of which finer tiles are drawn. A grid takes the
/// place of those that lie within it, and one that is not kept that of all of its layer: what is seen is what
/// was forwarded last. Keeps at most `budget` bytes; what came first goes first.
class ForwardedGrids {
 public:
  static constexpr std::size_t kBudget = std::size_t{16} << 20;
  /// That are looked at for one block of tiles: a second of work on a small board.
  static constexpr std::size_t kMostCells = std::size_t{256} << 20;

  explicit ForwardedGrids(std::size_t budget = kBudget) : budget_(budget) {}

  /// `number`: greater than any before. False where no finer tile can differ by it.
  bool take(std::shared_ptr<const ForwardedGrid> grid, std::uint64_t number);
  void clear();

  /// Those that lie in a part of an area, in the order in which they came: the last ones, of at most
  /// kMostCells.
  std::vector<std::shared_ptr<const ForwardedGrid>> in(const Layer& layer, const Area& area) const;
  /// The number of the last of them; 0: there is none.
  std::uint64_t newest_in(const Layer& layer, const Area& area) const;
  /// What there is of a layer, and what of it came after `since`. Nothing: nothing is finer than the mosaic.
  std::optional<Finer> finer(const Layer& layer, std::uint64_t since) const;
  std::size_t bytes() const { return bytes_; }

 private:
  struct Kept {
    std::shared_ptr<const ForwardedGrid> grid;
    std::uint64_t number = 0;
  };
  using Grids = std::vector<Kept>;  // oldest first; never empty
  void forget(Grids& grids, Grids::iterator first, Grids::iterator end);
  void keep_to_budget();

  std::size_t budget_, bytes_ = 0;
  std::map<Layer, Grids> layers_;
};

}  // namespace adit::picture
