#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "icd/mapping.hpp"
#include "queues/lattice.hpp"
#include "queues/queued_map.hpp"

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

  std::uint64_t number() const { return number_; }
  /// The grid's cells on this lattice, or nothing if the grid has another lattice.
  std::optional<Cells> cells_of(const icd::OccupancyGrid& grid) const { return cells_in(lattice_, grid); }

  /// Whether the last sent value is known for each cell of `all` that is in none of `grids`. All cells are
  /// counted from the lower left cell of `from`. Each look at a tile, or at a grid in it, takes one of
  /// `looks`; false if none is left.
  bool knows(const Cells& from, Cells all, std::span<const Cells> grids, std::size_t& looks) const;

  /// The known cells there.
  Ground ground_at(const Cells& cells) const;
  /// Marks cells that are being sent as unknown, until lay(). Requires at most kMostTouched tiles.
  void forget(const Cells& cells);
  /// Sets cells drawn over ground_at(). `when`: the number of this lay(). Tiles forgotten since stay unknown.
  void lay(const Ground& drawn, std::uint64_t when) noexcept;

  std::size_t tiles() const { return tiles_.size(); }
  /// Appends to `when` the number of each tile with known cells.
  void add_times(std::vector<std::uint64_t>& when) const;
  /// Forgets the cells of tiles with a lower number.
  void forget_before(std::uint64_t when) noexcept;

 private:
  struct PlacedTile {
    std::shared_ptr<const CanvasTile> tile;
    std::uint64_t when = 0;  // 0: the cells are unknown
  };
  bool has_before(const Cells& cells) const { return before_ && before_->overlaps(cells); }

  std::uint64_t number_;
  icd::OccupancyGrid lattice_;
  std::optional<Cells> before_;
  std::map<std::pair<std::int64_t, std::int64_t>, PlacedTile> tiles_;  // by row and column
};

/// The cells that were last sent of each robot's grids. MapQueue stitches grids into one rectangle and fills
/// the gaps with these cells: each has the newest value that was packed, or was never sent to the present map
/// of the Command Post. A gap with unknown cells is not filled. Cells become unknown by the memory's limit, a
/// failed try, a restart, another Command Post, or a run that may still be the previous one. A map that
/// failed is retried before newer maps and drawn again, so a filled gap is never older than arrived cells.
class Canvases {
 public:
  static constexpr std::size_t kMostTiles = 4096;       // with known cells: 16 MiB
  static constexpr std::size_t kMostForgotten = 65536;  // tiles of all canvases
  static constexpr std::size_t kMostNames = 256;        // the grids of further names are unknown

  explicit Canvases(std::size_t most_tiles = kMostTiles) : most_tiles_(most_tiles) {}

  /// By the grids' name: the extent in which grids were posted, or sent. kAnyName stands for all names.
  using PostedAreas = std::map<std::string, Extent>;
  static constexpr const char* kAnyName = "*";

  /// Sets the Command Post that maps are sent to from now on.
  void lead_to(std::string command_post);
  /// Sets what earlier processes may have sent.
  void restore(PostedAreas before);
  /// The extent to record before `grid` is accepted, for later processes; nothing if it is recorded.
  std::optional<std::pair<std::string, Extent>> grows(const icd::MapUpdate& grid) const;
  void on_grown(const std::pair<std::string, Extent>& posted) {
    posted_.insert_or_assign(posted.first, posted.second);
  }
  /// The Command Post has answered with a status of the present run. It was asked after all grids that were
  /// sent before the previous status had arrived, except those that are still in flight (`under_way`).
  void on_status(std::span<const icd::MapUpdate* const> under_way);
  /// The run may have changed: the Command Post's cells are unknown.
  void change_run() { canvases_.clear(); }
  /// A run has begun with an empty map after the last status of the previous run. Grids that were sent since
  /// the status before that one may have arrived in the new run. What other Command Posts have stays.
  void begin_run();
  /// An earlier run goes on: its map may have any cell that was posted.
  void resume_run();

  const Canvas* find(const std::optional<icd::RobotName>& name) const;

  /// Call before `next` is packed: sets its `ground` if the grid is to be drawn. If this throws, fewer cells
  /// are known and `next` is unchanged.
  void on_send(QueuedMap& next);
  /// Sets the cells as they were drawn over that ground.
  void lay(const std::optional<icd::RobotName>& name, const Ground& drawn);

 private:
  /// The grids that were sent to one Command Post.
  struct SentGrids {
    PostedAreas all;  // what its present map may have
    PostedAreas newer,
        older;  // sent since the last status of the present run; between that and the one before
  };
  SentGrids& present_grids();
  void forget_oldest();

  std::size_t most_tiles_;
  std::string command_post_;
  std::map<std::optional<icd::RobotName>, Canvas> canvases_;
  PostedAreas before_, posted_;            // until this process start, and until now
  std::map<std::string, SentGrids> sent_;  // by Command Post
  std::uint64_t numbers_ = 0, laid_ = 0;
};

}  // namespace adit::queues
