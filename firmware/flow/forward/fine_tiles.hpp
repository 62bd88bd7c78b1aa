#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "api/finer_map.hpp"
#include "loop/workers.hpp"
#include "picture/fine.hpp"

namespace adit::forward {

/// Finer tiles of delivered grids. A worker draws one block at a time on request and gives way to messages.
/// Blocks are kept until a grid arrives there.
class FineTiles final : public api::FinerMap {
 public:
  static constexpr std::size_t kMostDrawn = std::size_t{4} << 20;  // bytes of tiles
  static constexpr std::size_t kMostAskers = 256;

  /// Both outlive this. `mosaic`: the base of the grids.
  FineTiles(loop::Workers& workers, const picture::Mosaic& mosaic) : workers_(workers), mosaic_(mosaic) {}

  /// False if no finer tile can differ.
  bool take(std::shared_ptr<const picture::ForwardedGrid> grid, std::uint64_t number) {
    return grids_.take(std::move(grid), number);
  }
  void clear();

  std::optional<picture::Finer> finer(const picture::Layer& layer, std::uint64_t since) const override {
    return grids_.finer(layer, since);
  }
  void tile(const picture::Layer& layer, const picture::TileIndex& at, Done done) override;
  std::size_t bytes() const { return grids_.bytes() + drawn_bytes_; }

 private:
  /// A block, by the coarser tile that it replaces.
  struct Place {
    picture::Layer layer;
    picture::TileIndex over;
    friend auto operator<=>(const Place&, const Place&) = default;
  };
  /// The source of a block.
  struct Of {
    std::uint64_t newest = 0;
    picture::Tile base;
    friend bool operator==(const Of&, const Of&) = default;
  };
  struct Drawn {
    Of of;
    picture::FineBlock tiles;
    std::size_t bytes = 0;
    std::uint64_t used = 0;  // order of use
  };
  struct Asker {
    picture::TileIndex at;
    Done done;
  };
  struct Job;

  Of of(const Place& place) const;
  const picture::FineBlock* found(const Place& place, const Of& of);
  void pump();
  void draw(const Place& place, Of of, std::vector<Asker> askers);
  void drawn(const Job& job);
  void keep(const Place& place, const Of& of, const picture::FineBlock& tiles);

  loop::Workers& workers_;
  const picture::Mosaic& mosaic_;
  picture::ForwardedGrids grids_;
  std::map<Place, Drawn> drawn_;
  std::size_t drawn_bytes_ = 0;
  std::uint64_t uses_ = 0;
  std::map<Place, std::vector<Asker>> askers_;
  std::deque<Place> waiting_;  // each has askers
  bool is_drawing_ = false;
};

}  // namespace adit::forward
