#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "queues/extent.hpp"
#include "queues/ground.hpp"
#include "queues/lattice.hpp"

namespace adit::queues {

/// The cells that were last sent of the grids of one name and lattice, as far as they are known.
class Canvas {
 public:
  /// The most tiles that one map may touch, so that one drawing step is bounded.
  static constexpr std::int64_t kMostTouched = 1200;

  /// `lattice`: any grid of the lattice. `before`: where cells were sent whose values are no longer known.
  Canvas(std::uint64_t number, const icd::OccupancyGrid& lattice, const std::optional<Extent>& before);

  /// Whether a canvas can hold the grid: it is not rotated, and not too large.
  static bool can_draw(const icd::OccupancyGrid& grid);

  /// Whether the grid's cells lie along the axes of the frame.
  static bool is_straight(const icd::OccupancyGrid& grid);

  std::uint64_t number() const { return number_; }
  /// The grid's cells on this lattice, or nothing if the grid has another lattice.
  std::optional<Cells> cells_of(const icd::OccupancyGrid& grid) const { return cells_in(lattice_, grid); }

  /// Whether the last sent value is known for each cell of `all` that is in none of `grids`. All cells are
  /// counted from the lower left cell of `from`. Each look at a tile, or at a grid in it, takes one of
  /// `looks`; false if none is left.
  bool knows(const Cells& from, Cells all, std::span<const Cells> grids, std::size_t& looks) const;

  /// The known cells there.
  Ground under(const Cells& cells) const;
  /// Marks cells that are being sent as unknown, until lay(). Requires at most kMostTouched tiles.
  void forget(const Cells& cells);
  /// Sets the cells that were drawn over under(). `when`: the number of this lay(), a count. Tiles that were
  /// forgotten since then stay unknown.
  void lay(const Ground& drawn, std::uint64_t when) noexcept;

  std::size_t tiles() const { return tiles_.size(); }
  /// Appends to `when` the number of each tile with known cells.
  void add_times(std::vector<std::uint64_t>& when) const;
  /// Forgets the cells of tiles with a lower number.
  void forget_before(std::uint64_t when) noexcept;

 private:
  struct Laid {
    std::shared_ptr<const CanvasTile> tile;
    std::uint64_t when = 0;  // 0: the cells are unknown
  };
  bool has_before(const Cells& cells) const { return before_ && before_->overlaps(cells); }

  std::uint64_t number_;
  icd::OccupancyGrid lattice_;
  std::optional<Cells> before_;
  std::map<std::pair<std::int64_t, std::int64_t>, Laid> tiles_;  // by row and column
};

}  // namespace adit::queues
