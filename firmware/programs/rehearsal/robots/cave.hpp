#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// Draws that are the same on every machine for one seed, unlike the distributions of <random>.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// From `low` to below `high`.
  double uniform(double low, double high) {
    constexpr double kStep = 1.0 / static_cast<double>(1ull << 53);
    return low + (high - low) * static_cast<double>(engine_() >> 11) * kStep;
  }

  bool chance(double probability) { return uniform(0, 1) < probability; }

  /// From 0 to below `count`, which is above 0.
  std::size_t uniform_index(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

  /// Bell-shaped about 0 (Irwin-Hall of four), standard deviation `sigma`.
  double noise(double sigma) {
    constexpr double kUnitSigma = 0.57735026918962576;  // of the sum of four draws from -0.5 to 0.5
    return sigma / kUnitSigma *
           (uniform(-0.5, 0.5) + uniform(-0.5, 0.5) + uniform(-0.5, 0.5) + uniform(-0.5, 0.5));
  }

 private:
  std::mt19937_64 engine_;
};

struct Cell {
  int x = 0, y = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// The square lattice of the cave, each robot's knowledge and each grid: row by row from the lower left.
struct Lattice {
  double resolution = 1;  // metres
  double left = 0;        // metres, of cell (0, 0)'s lower left corner
  double bottom = 0;
  int width = 0, height = 0;

  bool contains(Cell cell) const { return cell.x >= 0 && cell.y >= 0 && cell.x < width && cell.y < height; }
  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(cell.x);
  }
  Cell cell_at(std::size_t index) const {
    return {static_cast<int>(index % static_cast<std::size_t>(width)),
            static_cast<int>(index / static_cast<std::size_t>(width))};
  }
  Cell cell_at(double x, double y) const {
    return {static_cast<int>(std::floor((x - left) / resolution)),
            static_cast<int>(std::floor((y - bottom) / resolution))};
  }
  double centre_x(Cell cell) const { return left + (cell.x + 0.5) * resolution; }
  double centre_y(Cell cell) const { return bottom + (cell.y + 0.5) * resolution; }
};

/// A value for each cell of a lattice.
template <class T>
class Raster {
 public:
  Raster(const Lattice& lattice, T value) : lattice_(lattice), values_(lattice.size(), value) {}

  const Lattice& lattice() const { return lattice_; }
  T& operator[](Cell cell) { return values_[lattice_.index(cell)]; }
  const T& operator[](Cell cell) const { return values_[lattice_.index(cell)]; }

 private:
  Lattice lattice_;
  std::vector<T> values_;
};

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
  bool can_see(const Vector3& from, const Vector3& to) const;

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
