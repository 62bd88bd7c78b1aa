#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

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

  /// `changed` is called after each change of the picture. `mosaic`: what an earlier one has drawn.
  MapPicture(loop::Loop& loop, loop::Workers& workers, std::function<void()> changed,
             picture::Mosaic mosaic = picture::Mosaic());

  /// The Command Post took this map. It need not be drawn if a later one covers it.
  void forwarded(icd::MapUpdate map);
  /// What was drawn of this run before is about to come: until it has, nothing is drawn, for kMostHeld at
  /// most.
  void hold();
  /// It has come.
  void go_on_from(picture::Mosaic earlier);
  /// A new run: forgets all that was drawn, and all that waits to be.
  void begin_run();

  const picture::Mosaic& mosaic() const { return mosaic_; }
  /// The picture, for the MapPicture that follows this one, without the maps that still wait. Ends this.
  picture::Mosaic hand_over();

 private:
  struct Waiting {
    icd::MapUpdate map;
    double stamp = 0;  // when it was forwarded, on the gateway's clock
  };
  struct Drawn {
    picture::Layer layer;
    double stamp = 0;
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
  std::deque<Waiting> waiting_;  // oldest first
  std::size_t waiting_bytes_ = 0;
  std::optional<Drawn> drawing_;  // that is under way
  loop::Instant held_until_{};
};

}  // namespace adit::forward
