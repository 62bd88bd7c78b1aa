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

/// The picture of the maps as the Command Post took them. They are drawn on a worker, one after the other,
/// while no map waits to be packed: a map on its way is more urgent than a picture, but only up to kPatience.
class MapPicture {
 public:
  static constexpr std::chrono::milliseconds kPatience{2000};
  /// Bytes of maps that wait to be drawn; above it the oldest is not drawn, and is counted as missed.
  static constexpr std::size_t kMostWaiting = std::size_t{64} << 20;

  /// `packing`: whether a map is being packed. `changed` is called after each change of the picture.
  /// `mosaic`: what an earlier one has drawn.
  MapPicture(loop::Loop& loop, loop::Workers& workers, std::function<bool()> packing,
             std::function<void()> changed, picture::Mosaic mosaic = picture::Mosaic());

  /// The Command Post took this map. It need not be drawn if a later one covers it.
  void forwarded(icd::MapUpdate map);
  /// A new run: forgets all that was drawn, and all that waits to be.
  void begin_run();

  const picture::Mosaic& mosaic() const { return mosaic_; }
  /// The picture, for the MapPicture that follows this one, without the maps that still wait. Ends this.
  picture::Mosaic hand_over();

 private:
  struct Waiting {
    icd::MapUpdate map;
    double stamp = 0;     // when it was forwarded, on the gateway's clock
    loop::Instant since;  // the same, on the loop's
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
  std::function<bool()> packing_;
  std::function<void()> changed_;
  loop::Source wake_;
  picture::Mosaic mosaic_;
  std::deque<Waiting> waiting_;  // oldest first
  std::size_t waiting_bytes_ = 0;
  std::optional<Drawn> drawing_;  // that is under way
};

}  // namespace adit::forward
