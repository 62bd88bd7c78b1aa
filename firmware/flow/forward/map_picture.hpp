#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "api/covered_map.hpp"
#include "forward/fine_tiles.hpp"
#include "icd/grid_bounds.hpp"
#include "icd/map_update.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "picture/mosaic.hpp"

namespace adit::forward {

/// Counts the covered area on request. A worker counts and gives way to messages.
class CoveredCount final : public api::CoveredMap {
 public:
  static constexpr std::size_t kMostAskers = 256;

  /// Both outlive this.
  CoveredCount(loop::Workers& workers, const picture::Mosaic& mosaic) : workers_(workers), mosaic_(mosaic) {}

  void covered(Done done) override;

 private:
  struct Job;
  void pump();
  void counted(const Job& job);

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
  void forwarded(icd::MapUpdate map);
  /// Draws no map until go_on_from(), at most for kMostHeld.
  void hold();
  void go_on_from(picture::Mosaic earlier);
  /// Forgets the picture and its queue.
  void begin_run();
  /// The time of day was set ahead by `seconds`.
  void move(double seconds);

  const picture::Mosaic& mosaic() const { return mosaic_; }
  api::FinerMap& finer() { return fine_; }
  api::CoveredMap& covered() { return covered_; }
  std::size_t finer_bytes() const { return fine_.bytes(); }

 private:
  struct Waiting {
    icd::MapUpdate map;
    double stamp = 0;  // forwarded at this time of day
    /// For a grid: the bounds of it and of all that it replaced here.
    std::optional<icd::GridBounds> bounds{};
  };
  struct Job;

  void pump();
  void draw(Waiting waiting);
  void drawn(Job& job);

  loop::Loop& loop_;
  loop::Workers& workers_;
  std::function<void()> changed_;
  loop::Source wake_;
  picture::Mosaic mosaic_;
  FineTiles fine_;
  CoveredCount covered_;
  std::deque<Waiting> waiting_;  // oldest first
  std::size_t waiting_bytes_ = 0;
  std::optional<double> drawing_;  // time of the map that is being drawn
  loop::Instant held_until_{};
};

}  // namespace adit::forward
