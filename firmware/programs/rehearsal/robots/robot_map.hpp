#pragma once

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

  /// What is known of the cells from `low` to `high`, both included, which may lie outside of the cave.
  Grid part(Cell low, Cell high, double stamp) const;
  /// The corners of all that is known, both included; there are none before the first sweep.
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

}  // namespace adit::robots
