#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "picture/mosaic.hpp"

namespace adit::archive {

/// Identifies a tile of the map.
using TileKey = std::pair<picture::Layer, picture::TileIndex>;

/// Decides which tiles to write next: changed ones, each at most once per interval_of() its level. The
/// interval keeps coarse tiles, which change with every fine one below, from displacing fine ones. Order:
/// never written, then the oldest write first.
///
/// Also tracks the file of each tile's newest state, because a file without newest states may be removed.
class DueTiles {
 public:
  /// Seconds between two writes of a tile: 4 for the finest level, 4 times as many for each coarser one.
  static double interval_of(int level);

  /// Marks tiles that changed since the last look.
  void look(const picture::Mosaic& picture);
  /// Tiles to write at `now` (seconds that never step), in order.
  std::vector<TileKey> at(double now) const;
  /// Records that write number `write` takes the tile's state at `now`.
  void being_written(const TileKey& tile, std::uint64_t write, double now);
  /// Records the write's file. std::nullopt: the write failed, and its tiles are due again.
  void done(std::uint64_t write, std::optional<std::uint64_t> file);
  /// Makes the tiles of that file due, so that the file can be removed. True: it has no newest states.
  bool leave(std::uint64_t file);
  /// Starts with the tiles of `picture` that are stored in `files`.
  void begin(const picture::Mosaic& picture, const std::map<TileKey, std::uint64_t>& files);

 private:
  struct Tile {
    double written = 0;       // 0: never
    std::uint64_t file = 0;   // 0: none
    std::uint64_t write = 0;  // in flight; 0: none
    bool due = false;
  };
  std::map<TileKey, Tile> tiles_;
  std::uint64_t seen_ = 0;  // Mosaic::version()
};

}  // namespace adit::archive
