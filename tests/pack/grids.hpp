#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "icd/mapping.hpp"

namespace adit::pack {

struct Grid {
  std::string what;
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> cells;

  Grid(std::string name, std::size_t columns, std::size_t rows, std::uint8_t cell = icd::kUnknownCell)
      : what(std::move(name)), width(columns), height(rows), cells(columns * rows, cell) {}
  std::uint8_t& at(std::size_t x, std::size_t y) { return cells[y * width + x]; }

  icd::MapUpdate update() const {
    icd::OccupancyGrid grid;
    grid.resolution = 0.1;
    grid.width = static_cast<std::uint32_t>(width);
    grid.height = static_cast<std::uint32_t>(height);
    return {{}, grid, {icd::ChunkedBytes(cells), icd::Compression::None, cells.size()}};
  }
};

/// Makes cells within a circle free, and unknown cells at its edge occupied. Clips at the grid's border.
inline void dig(Grid& grid, double x, double y, double radius) {
  const auto reach = static_cast<long>(radius) + 2;
  for (long dy = -reach; dy <= reach; ++dy) {
    for (long dx = -reach; dx <= reach; ++dx) {
      const long column = static_cast<long>(x) + dx, row = static_cast<long>(y) + dy;
      if (column < 0 || row < 0 || column >= static_cast<long>(grid.width) ||
          row >= static_cast<long>(grid.height))
        continue;
      std::uint8_t& cell = grid.at(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
      const double away = std::hypot(static_cast<double>(dx), static_cast<double>(dy));
      if (away < radius) cell = 0;
      if (away >= radius && away < radius + 1.5 && cell == icd::kUnknownCell) cell = icd::kMostOccupied;
    }
  }
}

/// Tunnels with rough walls.
inline Grid cave(std::size_t width, std::size_t height, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Grid grid("cave", width, height);
  const auto part = [&] { return static_cast<double>(random() % 1000) / 1000; };
  const double wide = static_cast<double>(width), high = static_cast<double>(height);
  for (int tunnel = 0; tunnel < 8; ++tunnel) {
    double x = wide / 2, y = high / 2, heading = part() * 6.28;
    const double radius = std::min(wide, high) * (0.005 + part() * 0.01) + 1;
    for (int step = 0; step < 400; ++step) {
      heading += (part() - 0.5) / 2;
      x = std::clamp(x + std::cos(heading) * radius * 0.5, 0.0, wide - 1);
      y = std::clamp(y + std::sin(heading) * radius * 0.5, 0.0, high - 1);
      dig(grid, x, y, radius * (0.8 + part() * 0.4));
    }
  }
  return grid;
}

/// Adds costs around walls, as planners inflate them: the same patterns everywhere.
inline Grid graded(Grid grid) {
  constexpr long kReach = 6;
  const std::vector<std::uint8_t> walls = grid.cells;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (walls[i] != icd::kMostOccupied) continue;
    const long x = static_cast<long>(i % grid.width), y = static_cast<long>(i / grid.width);
    for (long dy = -kReach; dy <= kReach; ++dy) {
      for (long dx = -kReach; dx <= kReach; ++dx) {
        const long column = x + dx, row = y + dy;
        if (column < 0 || row < 0 || column >= static_cast<long>(grid.width) ||
            row >= static_cast<long>(grid.height))
          continue;
        std::uint8_t& cell = grid.at(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
        const double cost = 99 * std::exp(-std::hypot(static_cast<double>(dx), static_cast<double>(dy)) / 3);
        if (cell < 100) cell = std::max(cell, static_cast<std::uint8_t>(cost));
      }
    }
  }
  grid.what = "graded " + grid.what;
  return grid;
}

/// One cell in a hundred has another value.
inline Grid speckled(Grid grid) {
  std::mt19937_64 random(grid.cells.size());
  for (std::size_t i = 0; i < grid.cells.size() / 100; ++i)
    grid.cells[random() % grid.cells.size()] = icd::kMostOccupied;
  grid.what = "speckled " + grid.what;
  return grid;
}

/// Known cells get measured probabilities.
inline Grid measured(Grid grid) {
  std::mt19937_64 random(grid.cells.size());
  for (std::uint8_t& cell : grid.cells) {
    if (cell != icd::kUnknownCell)
      cell = static_cast<std::uint8_t>(cell == 0 ? random() % 8 : 92 + random() % 9);
  }
  grid.what = "measured " + grid.what;
  return grid;
}

/// Random cells with `values` equally likely values.
inline Grid noise(std::size_t width, std::size_t height, unsigned values) {
  std::mt19937_64 random(values);
  Grid grid("noise of " + std::to_string(values), width, height);
  for (std::uint8_t& cell : grid.cells) cell = static_cast<std::uint8_t>(random() % values);
  return grid;
}

}  // namespace adit::pack
