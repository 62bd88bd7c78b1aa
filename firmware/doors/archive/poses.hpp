#pragma once

#include <map>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/lines.hpp"

namespace adit::archive {

/// Which poses of the robots are stored or queued.
class Poses {
 public:
  Poses() = default;
  /// `stored`: from before a restart.
  explicit Poses(const std::vector<api::Track>& stored);

  /// Time of the newest stored or queued pose.
  api::Time last() const { return last_; }
  /// Queues poses since last(). Call once for each `now`: if the time of day was set back, a second call
  /// would store the same poses again.
  void add_to(Lines& lines, const std::vector<api::Track>& tracks, api::Time now);
  /// Call if the time of day was advanced by `seconds`.
  void move(double seconds) { last_ += seconds; }

 private:
  bool has_moved(const api::Track& track);

  api::Time last_ = 0;
  std::map<std::string, api::TrackPose> by_robot_;  // last added
};

}  // namespace adit::archive
