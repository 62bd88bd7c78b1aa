#pragma once

#include <cmath>
#include <vector>

namespace adit::robots {

struct Cell {
  int x = 0, y = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// The square lattice that the cave, every robot's knowledge of it and every grid lie on: row by row from
/// the lower left.
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
  const std::vector<T>& values() const { return values_; }

 private:
  Lattice lattice_;
  std::vector<T> values_;
};

}  // namespace adit::robots
