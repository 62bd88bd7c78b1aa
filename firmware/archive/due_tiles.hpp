#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "picture/mosaic.hpp"

namespace adit::archive {

/// A tile of the picture.
using TileKey = std::pair<picture::Layer, picture::TileAt>;

/// Which tiles are to be written next: those that have changed since they were, each at most once in
/// interval_of() its level, so that a coarse one, which changes with every fine one below it, does not take
/// their room. Of those the one comes first whose last writing is longest ago; one that was never written
/// comes before all others.
///
/// It also knows in which file the newest state of each tile is, for a file without any may go.
class DueTiles {
 public:
  /// Seconds from one writing of a tile to the next: 4 for the finest, 4 times that for each coarser level.
  static double interval_of(int level);

  /// What of the picture changed since the last look is due from now on.
  void look(const picture::Mosaic& picture);
  /// Those to be written at `now`, in seconds since 1970, in their order.
  std::vector<TileKey> at(double now) const;
  /// Its state of now is being written, by the write of that number, at `now`.
  void being_written(const TileKey& tile, std::uint64_t write, double now);
  /// That write is done: what it wrote is in that file; nothing: it failed, and is due again.
  void done(std::uint64_t write, std::optional<std::uint64_t> file);

  /// The time of day was set ahead by so many seconds.
  void move(double seconds) {
    for (auto& [at, tile] : tiles_) {
      if (tile.written != 0) tile.written += seconds;
    }
  }
  /// The states in that file are to be written again, so that it may go. True: it holds no newest state.
  bool leave(std::uint64_t file);
  /// Of the picture, these tiles are written, in these files.
  void begin(const picture::Mosaic& picture, const std::map<TileKey, std::uint64_t>& files);

 private:
  struct Tile {
    double written = 0;       // 0: never
    std::uint64_t file = 0;   // 0: none
    std::uint64_t write = 0;  // that is under way; 0: none
    bool due = false;
  };
  std::map<TileKey, Tile> tiles_;
  std::uint64_t seen_ = 0;  // Mosaic::version()
};

}  // namespace adit::archive
