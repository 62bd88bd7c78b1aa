#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "api/source.hpp"
#include "icd/grid_bounds.hpp"
#include "icd/mapping.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "picture/fine.hpp"
#include "picture/mosaic.hpp"

namespace adit::forward {

/// Finer tiles of delivered grids. A worker draws one block at a time on request and gives way to messages.
/// Blocks are kept until a grid arrives there.
class FineTiles final : public api::FineMap {
 public:
  static constexpr std::size_t kMostDrawn = std::size_t{4} << 20;  // bytes of tiles
  static constexpr std::size_t kMostAskers = 256;

  /// Both outlive this. `mosaic`: the base of the grids.
  FineTiles(loop::Workers& workers, const picture::Mosaic& mosaic) : workers_(workers), mosaic_(mosaic) {}

  /// False if no finer tile can differ.
  bool add(std::shared_ptr<const picture::ForwardedGrid> grid, std::uint64_t number) {
    return grids_.add(std::move(grid), number);
  }
  void clear();

  std::optional<picture::FinerLevels> finer_levels(const picture::Layer& layer,
                                                   std::uint64_t since) const override {
    return grids_.finer_levels(layer, since);
  }
  void tile(const picture::Layer& layer, const picture::TileIndex& at, Done done) override;
  std::size_t bytes() const { return grids_.bytes() + drawn_bytes_; }

 private:
  /// A block, by the coarser tile that it replaces.
  struct BlockKey {
    picture::Layer layer;
    picture::TileIndex over;
    friend auto operator<=>(const BlockKey&, const BlockKey&) = default;
  };
  struct BlockSource {
    std::uint64_t newest = 0;
    picture::Tile base;
    friend bool operator==(const BlockSource&, const BlockSource&) = default;
  };
  struct CachedBlock {
    BlockSource of;
    picture::FineBlock tiles;
    std::size_t bytes = 0;
    std::uint64_t used = 0;  // order of use
  };
  struct Asker {
    picture::TileIndex at;
    Done done;
  };
  struct Job;

  BlockSource areas_at(const BlockKey& place) const;
  const picture::FineBlock* find_block(const BlockKey& place, const BlockSource& of);
  void pump();
  void draw(const BlockKey& place, BlockSource of, std::vector<Asker> askers);
  void on_drawn(const Job& job);
  void keep(const BlockKey& place, const BlockSource& of, const picture::FineBlock& tiles);

  loop::Workers& workers_;
  const picture::Mosaic& mosaic_;
  picture::ForwardedGrids grids_;
  std::map<BlockKey, CachedBlock> drawn_;
  std::size_t drawn_bytes_ = 0;
  std::uint64_t uses_ = 0;
  std::map<BlockKey, std::vector<Asker>> askers_;
  std::deque<BlockKey> waiting_;  // each has askers
  bool is_drawing_ = false;
};

/// Counts the covered area on request. A worker counts and gives way to messages.
class CoveredCount final : public api::CoveredMap {
 public:
  static constexpr std::size_t kMostAskers = 256;

  /// Both outlive this.
  CoveredCount(loop::Workers& workers, const picture::Mosaic& mosaic) : workers_(workers), mosaic_(mosaic) {}

  void count(Done done) override;

 private:
  struct Job;
  void pump();
  void on_counted(const Job& job);

  loop::Workers& workers_;
  const picture::Mosaic& mosaic_;
  std::vector<Done> askers_;  // of the next count
  bool is_counting_ = false;
  std::shared_ptr<picture::CoveredArea> area_ = std::make_shared<picture::CoveredArea>();  // a running job's
};

/// The picture of delivered maps. A worker draws one at a time and gives way to messages (loop::JobQueue).
class MapPicture {
 public:
  /// Bytes of maps to be drawn. Beyond that the oldest are not drawn and count as missed.
  static constexpr std::size_t kMostWaiting = std::size_t{64} << 20;

  /// Longest wait for the earlier picture.
  static constexpr std::chrono::seconds kMostHeld{10};

  MapPicture(loop::Loop& loop, loop::Workers& workers, std::function<void()> changed);

  /// Draws an accepted map, unless a later one covers it.
  void on_forwarded(icd::MapUpdate map);
  /// Draws no map until restore(), at most for kMostHeld.
  void hold() { held_until_ = loop_.now() + kMostHeld; }
  void restore(picture::Mosaic earlier);
  /// Forgets the picture and its queue.
  void begin_run();
  /// The time of day was set ahead by `seconds`.
  void move(double seconds);

  const picture::Mosaic& mosaic() const { return mosaic_; }
  api::FineMap& fine_map() { return fine_; }
  api::CoveredMap& covered_map() { return covered_; }
  std::size_t finer_bytes() const { return fine_.bytes(); }

 private:
  struct QueuedDrawing {
    icd::MapUpdate map;
    double stamp = 0;  // forwarded at this time of day
    /// For a grid: the bounds of it and of all that it replaced here.
    std::optional<icd::GridBounds> bounds{};
  };
  struct Job;

  void pump();
  void draw(QueuedDrawing waiting);
  void on_drawn(Job& job);

  loop::Loop& loop_;
  loop::Workers& workers_;
  std::function<void()> changed_;
  loop::Source wake_;
  picture::Mosaic mosaic_;
  FineTiles fine_;
  CoveredCount covered_;
  std::deque<QueuedDrawing> waiting_;  // oldest first
  std::size_t waiting_bytes_ = 0;
  std::optional<double> drawing_;  // time of the map that is being drawn
  loop::Instant held_until_{};
};

}  // namespace adit::forward
