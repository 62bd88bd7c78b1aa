#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "forward/marker_scene.hpp"
#include "forward/tracks.hpp"
#include "icd/markers_update.hpp"
#include "icd/state_update.hpp"

namespace adit::forward {

/// Robots and markers as the Command Post has them, without queued messages.
class DeliveredScene {
 public:
  static constexpr std::size_t kMostRobots = 100;  // the latest ones

  /// Poses that robots posted, not ones that a state repeats.
  void forwarded(std::span<const icd::NamedPose> poses, api::Time now);
  void forwarded(std::span<const icd::Marker> markers, api::Time now) { markers_.forwarded(markers, now); }
  /// Robots keep their positions.
  void begin_run(api::Time now);

  /// The time of day was set ahead by `seconds`: adjusts all times.
  void move(double seconds);

  /// Restores the tracks of this run from before a restart.
  void go_on_from(std::vector<api::Track> earlier);

  /// Last poses, by name.
  std::vector<api::RobotRow> robots() const;
  /// Last pose of each robot in this run before a restart.
  const std::map<std::string, api::Time>& before() const { return before_; }
  const MarkerScene& markers() const { return markers_; }
  const Tracks& tracks() const { return tracks_; }

 private:
  void forget_the_oldest();

  std::map<std::string, api::RobotRow> robots_;
  std::map<std::string, api::Time> before_;
  MarkerScene markers_;
  Tracks tracks_;
};

}  // namespace adit::forward
