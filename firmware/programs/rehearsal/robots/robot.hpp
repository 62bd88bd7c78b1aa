#pragma once

#include <cstdint>
#include <vector>

#include "rehearsal/robots/cave.hpp"

namespace adit::robots {

/// What one robot knows of the cave: how surely each cell is rock, and the points that its lidar measured
/// since they were last taken.
class RobotMap {
 public:
  explicit RobotMap(const Lattice& lattice);

  const Lattice& lattice() const { return cells_.lattice(); }
  bool is_known(Cell cell) const { return cells_[cell] != kUnknown; }
  bool is_free(Cell cell) const { return cells_[cell] < 50; }
  bool is_rock(Cell cell) const { return cells_[cell] > 50 && cells_[cell] != kUnknown; }

  /// Sweeps a lidar once round from `from`: cells become surer with each sweep, and those seen for the
  /// first time add their points.
  void sweep(const Cave& cave, const Vector3& from, Random& random);

  /// All that is known, from the lower left cell known to the upper right one; each grid covers the one
  /// before it. Requires a sweep.
  Grid grid(double stamp) const;

  /// The known state of the cells from `low` to `high`, both included, which may lie outside of the cave.
  Grid part(Cell low, Cell high, double stamp) const;
  /// The corners of the known cells, both included. Before the first sweep, low() is above high().
  Cell low() const { return low_; }
  Cell high() const { return high_; }

  /// The points measured since the last call (x, y, z, intensity as float32), each once.
  Cloud take_new_points(double stamp);

 private:
  void see_floor(const Cave& cave, Cell cell, Random& random);
  void see_rock(Cell cell, double floor, double ceiling, Random& random);
  void see_point(double x, double y, double z, double intensity, Random& random);
  void include(Cell cell);

  Raster<std::uint8_t> cells_;
  Cell low_, high_;  // inclusive; of all that is known
  std::vector<float> points_;
};

/// Whether the robot's body fits: the cell is free and no cell beside it is rock.
bool is_walkable(const RobotMap& map, Cell cell);

/// Whether what lies beside a walkable cell is not known yet.
bool is_frontier(const RobotMap& map, Cell cell);

/// The way from `start`, over walkable cells wherever it can, to the best frontier: near, and in the
/// direction `heading` (radians) that this robot prefers, so that a team spreads out. If all is explored, the
/// way to some place that `random` chooses. Empty if there is no way.
std::vector<Cell> way_to_explore(const RobotMap& map, Cell start, double heading, Random& random);

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
