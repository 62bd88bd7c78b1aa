#pragma once

#include <cstdint>
#include <vector>

#include "rehearsal/robots/cave.hpp"
#include "rehearsal/robots/robot_map.hpp"

namespace adit::robots {

/// One robot in the cave: it walks to what it does not know yet, sees with its lidar, and notices artifacts
/// that come near. Reads no clock: time passes in advance().
class Robot {
 public:
  /// `cave` outlives the robot. The same seed and index give the same walk.
  Robot(const Cave& cave, std::uint64_t seed, std::size_t index);

  static constexpr double kSightRange = 7;  // metres at which it knows an artifact

  /// Walks `metres` and looks round once.
  void advance(double metres);

  Placement pose() const;
  double walked() const { return walked_; }  // metres in all
  RobotMap& map() { return map_; }

  /// Indices in cave.artifacts() of those seen since the last call, each once in a robot's life.
  std::vector<std::size_t> take_sightings();

 private:
  void step(double metres);
  void notice();

  const Cave& cave_;
  Random random_;
  RobotMap map_;
  double x_, y_, yaw_, preferred_;
  double walked_ = 0;
  std::vector<Cell> way_;  // the next cell is the last
  std::vector<bool> noticed_;
  std::vector<std::size_t> sightings_;
};

}  // namespace adit::robots
