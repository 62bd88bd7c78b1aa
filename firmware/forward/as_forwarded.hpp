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

/// Robots and markers as the Command Post knows them: what it took, and nothing that waits.
class AsForwarded {
 public:
  static constexpr std::size_t kMostRobots = 100;  // those heard of last

  /// Poses that robots posted. Do not pass poses that a state only repeats: a robot may have moved since.
  void forwarded(std::span<const icd::NamedPose> poses, api::Time now);
  void forwarded(std::span<const icd::Marker> markers, api::Time now) { markers_.forwarded(markers, now); }
  /// A new run begins without tracks and markers; where each robot is, it still is.
  void begin_run(api::Time now);

  /// The time of day was set ahead by so many seconds: each robot was there as long ago as it was.
  void move(double seconds);

  /// Where they were in this run before a restart.
  void go_on_from(std::vector<api::Track> earlier);

  /// Each robot's last pose, by name.
  std::vector<api::RobotRow> robots() const;
  /// When each was heard last in this run before a restart.
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
