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
#include "lanes/extent.hpp"
#include "lanes/ground.hpp"
#include "lanes/lattice.hpp"

namespace adit::lanes {

/// What was packed to be sent of one name's grids of one lattice, in the order of packing.
class Canvas {
 public:
  /// Most tiles that one map may touch: what is drawn at once is bounded.
  static constexpr std::int64_t kMostTouched = 1200;

  /// `lattice`: a grid of it. `before`: where something was sent that is not known any more.
  Canvas(std::uint64_t number, const icd::OccupancyGrid& lattice, const std::optional<Extent>& before);

  /// Whether what is sent of it can be known: it is not turned, and not too large.
  static bool can_draw(const icd::OccupancyGrid& grid);

  /// Whether its cells lie along the frame's axes.
  static bool is_straight(const icd::OccupancyGrid& grid);

  std::uint64_t number() const { return number_; }
  /// Nothing where it is of another lattice.
  std::optional<Cells> cells_of(const icd::OccupancyGrid& grid) const { return cells_in(lattice_, grid); }

  /// Whether it is known of each cell of `all` that none of `grids` has what was last sent there, if anything
  /// was; all are counted from the lower left cell of `from`. Each look at a tile, or at a grid in it, is one
  /// of `looks`; false once there are no more.
  bool knows(const Cells& from, Cells all, std::span<const Cells> grids, std::size_t& looks) const;

  /// What is known to lie there.
  Ground under(const Cells& cells) const;
  /// What is sent there now is not known until it is laid. Requires kMostTouched at most.
  void forget(const Cells& cells);
  /// What was drawn over under(), `when` by a count of what is laid. Where tiles were forgotten since, they
  /// stay so.
  void lay(const Ground& drawn, std::uint64_t when) noexcept;

  std::size_t tiles() const { return tiles_.size(); }
  /// When those with cells were laid, at the end of `when`.
  void add_times(std::vector<std::uint64_t>& when) const;
  /// Forgets the cells of those that were laid before.
  void forget_before(std::uint64_t when) noexcept;

 private:
  struct Laid {
    std::shared_ptr<const CanvasTile> tile;
    std::uint64_t when = 0;  // 0: its cells are not known
  };
  bool has_before(const Cells& cells) const { return before_ && before_->overlaps(cells); }

  std::uint64_t number_;
  icd::OccupancyGrid lattice_;
  std::optional<Cells> before_;
  std::map<std::pair<std::int64_t, std::int64_t>, Laid> tiles_;  // by row and column
};

}  // namespace adit::lanes
