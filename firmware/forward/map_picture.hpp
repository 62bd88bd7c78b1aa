#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "forward/fine_tiles.hpp"
#include "icd/map_update.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "picture/mosaic.hpp"

namespace adit::forward {

/// The picture of the maps as the Command Post took them. They are drawn on a worker, one after the other:
/// each can wait, and gives way to what is on its way to the Command Post (loop::JobQueue).
class MapPicture {
 public:
  /// Bytes of maps that wait to be drawn; above it the oldest is not drawn, and is counted as missed.
  static constexpr std::size_t kMostWaiting = std::size_t{64} << 20;

  /// How long what was drawn before is waited for.
  static constexpr std::chrono::seconds kMostHeld{10};

  /// `changed` is called after each change of the picture.
  MapPicture(loop::Loop& loop, loop::Workers& workers, std::function<void()> changed);

  /// The Command Post took this map. It need not be drawn if a later one covers it.
  void forwarded(icd::MapUpdate map);
  /// What was drawn of this run before is about to come: until it has, nothing is drawn, for kMostHeld at
  /// most.
  void hold();
  /// It has come.
  void go_on_from(picture::Mosaic earlier);
  /// A new run: forgets all that was drawn, and all that waits to be.
  void begin_run();
  /// The time of day was set ahead by so many seconds.
  void move(double seconds);

  const picture::Mosaic& mosaic() const { return mosaic_; }
  api::FinerMap& finer() { return fine_; }
  std::size_t finer_bytes() const { return fine_.bytes(); }

 private:
  struct Waiting {
    icd::MapUpdate map;
    double stamp = 0;  // when it was forwarded, by the time of day
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
  std::deque<Waiting> waiting_;  // oldest first
  std::size_t waiting_bytes_ = 0;
  std::optional<double> drawing_;  // when the map that is being drawn was forwarded
  loop::Instant held_until_{};
};

}  // namespace adit::forward
