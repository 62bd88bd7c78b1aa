#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "api/scene.hpp"

namespace adit::forward {

/// Where each robot was during the run, as the Command Post was told: about one pose a second while it moves,
/// one each kStill while it stands. A full track drops every other pose, and takes new ones half as often.
class Tracks {
 public:
  static constexpr std::size_t kMostPoses = 4000;     // of one robot: over an hour on its way
  static constexpr double kSpacing = 1, kStill = 10;  // seconds
  static constexpr double kMoved = 0.1;               // metres
  static constexpr double kTurned = 0.2;              // radians

  /// The caller bounds the number of robots.
  void forwarded(const std::string& robot, const api::TrackPose& pose);
  /// Where they were before; what is here already is later.
  void go_on_from(const std::vector<api::Track>& earlier);
  void wipe() { tracks_.clear(); }
  /// The time of day was set ahead by so many seconds.
  void move(double seconds);
  void forget(const std::string& robot) { tracks_.erase(robot); }

  /// By name, the poses later than `since`; robots without any are left out.
  std::vector<api::Track> since(api::Time since) const;

 private:
  struct Kept {
    std::vector<api::TrackPose> poses;
    double spacing = kSpacing;
  };
  std::map<std::string, Kept> tracks_;
};

}  // namespace adit::forward
