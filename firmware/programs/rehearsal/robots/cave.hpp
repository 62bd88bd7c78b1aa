#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rehearsal/robots/messages.hpp"
#include "rehearsal/robots/random.hpp"
#include "rehearsal/robots/raster.hpp"

namespace adit::robots {

/// What lies in the cave: one of the ICD's types (5.2), and where.
using Artifact = Report;

/// A cave of chambers and tunnels in two and a half dimensions: rock or open, with the height of floor and
/// ceiling wherever it is open. The same seed gives the same cave.
///
/// The entrance is at (0, 0, 0) of the "darpa" frame; every open cell can be walked to from there.
class Cave {
 public:
  static Cave generate(std::uint64_t seed);

  const Lattice& lattice() const { return open_.lattice(); }
  bool is_open(Cell cell) const { return lattice().contains(cell) && open_[cell] != 0; }
  double floor_at(Cell cell) const { return static_cast<double>(floor_[cell]); }
  double ceiling_at(Cell cell) const { return static_cast<double>(ceiling_[cell]); }
  Cell entrance() const { return lattice().cell_at(0, 0); }

  /// Whether the straight line between two places crosses no rock.
  bool in_sight(const Vector3& from, const Vector3& to) const;

  /// Two of each type, at least kApart from each other (so that a report within the 5 m that score can
  /// mean only one of them), the first within sight of the entrance.
  const std::vector<Artifact>& artifacts() const { return artifacts_; }
  static constexpr double kApart = 7;

  /// "type,x,y,z" and a line for each artifact: what a Command Post scores against.
  std::string truth_csv() const;

 private:
  explicit Cave(const Lattice& lattice);
  void place_artifacts(Random& random);

  Raster<std::uint8_t> open_;
  Raster<float> floor_;
  Raster<float> ceiling_;
  std::vector<Artifact> artifacts_;
};

}  // namespace adit::robots
