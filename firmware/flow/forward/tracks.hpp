#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "api/scene.hpp"

namespace adit::forward {

/// Positions that the Command Post has of the run: one a second in motion, one per kStill at rest. A full
/// track halves its poses and its rate.
class Tracks {
 public:
  static constexpr std::size_t kMostPoses = 4000;     // per robot: over an hour
  static constexpr double kSpacing = 1, kStill = 10;  // seconds

  /// Callers bound the number of robots.
  void forwarded(const std::string& robot, const api::TrackPose& pose);
  /// Adds earlier poses before the present ones.
  void go_on_from(const std::vector<api::Track>& earlier);
  void wipe() { tracks_.clear(); }
  /// The time of day was set ahead by `seconds`.
  void move(double seconds);
  void forget(const std::string& robot) { tracks_.erase(robot); }

  /// By name: poses later than `since`. Robots without such poses are left out.
  std::vector<api::Track> since(api::Time since) const;

 private:
  struct Kept {
    std::vector<api::TrackPose> poses;
    double spacing = kSpacing;
  };
  std::map<std::string, Kept> tracks_;
};

}  // namespace adit::forward
