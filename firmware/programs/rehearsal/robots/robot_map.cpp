#include "rehearsal/robots/robot_map.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

namespace adit::robots {
namespace {

constexpr double kRange = 12;  // metres
constexpr int kRays = 540;
constexpr double kPointNoise = 0.015;  // metres
constexpr std::size_t kValues = 4;     // of a point
static_assert(std::endian::native == std::endian::little, "clouds are sent little endian");

/// A cell's value after one more look: free cells sink from 45 to 0, rock rises from 55 to 100.
std::uint8_t surer(std::uint8_t value, bool rock) {
  constexpr int kFirst = 5, kStep = 15;
  const int before = value == kUnknown ? 50 : value;
  const int step = value == kUnknown ? kFirst : kStep;
  return static_cast<std::uint8_t>(std::clamp(before + (rock ? step : -step), 0, 100));
}

}  // namespace

RobotMap::RobotMap(const Lattice& lattice)
    : cells_(lattice, kUnknown), low_{lattice.width, lattice.height}, high_{-1, -1} {}

void RobotMap::include(Cell cell) {
  low_ = {std::min(low_.x, cell.x), std::min(low_.y, cell.y)};
  high_ = {std::max(high_.x, cell.x), std::max(high_.y, cell.y)};
}

void RobotMap::see_point(double x, double y, double z, double intensity, Random& random) {
  points_.push_back(static_cast<float>(x + random.noise(kPointNoise)));
  points_.push_back(static_cast<float>(y + random.noise(kPointNoise)));
  points_.push_back(static_cast<float>(z + random.noise(kPointNoise)));
  points_.push_back(static_cast<float>(intensity));
}

void RobotMap::see_floor(const Cave& cave, Cell cell, Random& random) {
  if (!is_known(cell)) {
    const double x = lattice().centre_x(cell), y = lattice().centre_y(cell);
    see_point(x, y, cave.floor_at(cell), 40 + 20 * random.between(0, 1), random);
    see_point(x, y, cave.ceiling_at(cell), 25 + 10 * random.between(0, 1), random);
    include(cell);
  }
  cells_[cell] = surer(cells_[cell], false);
}

void RobotMap::see_rock(Cell cell, double floor, double ceiling, Random& random) {
  if (!is_known(cell)) {
    const int points = static_cast<int>((ceiling - floor) / lattice().resolution) + 1;
    for (int i = 0; i < points; ++i) {
      const double z = floor + i * lattice().resolution;
      see_point(lattice().centre_x(cell), lattice().centre_y(cell), z, 80 + 40 * random.between(0, 1),
                random);
    }
    include(cell);
  }
  cells_[cell] = surer(cells_[cell], true);
}

void RobotMap::sweep(const Cave& cave, const Vector3& from, Random& random) {
  Raster<std::uint8_t> seen(lattice(), 0);  // each cell is looked at once a sweep
  const double step = lattice().resolution / 2;
  for (int ray = 0; ray < kRays; ++ray) {
    const double angle = 2 * std::numbers::pi * ray / kRays;
    const double along_x = std::cos(angle), along_y = std::sin(angle);
    Cell last = lattice().cell_at(from.x, from.y);
    for (int i = 0; i <= static_cast<int>(kRange / step); ++i) {
      const double range = i * step;
      const Cell cell = lattice().cell_at(from.x + range * along_x, from.y + range * along_y);
      if (!lattice().contains(cell)) break;
      const bool rock = !cave.is_open(cell);
      if (std::exchange(seen[cell], std::uint8_t{1}) == 0) {
        if (rock) {
          see_rock(cell, cave.floor_at(last), cave.ceiling_at(last), random);
        } else {
          see_floor(cave, cell, random);
        }
      }
      if (rock) break;
      last = cell;
    }
  }
}

Grid RobotMap::grid(double stamp) const {
  assert(low_.x <= high_.x);
  return part(low_, high_, stamp);
}

Grid RobotMap::part(Cell low, Cell high, double stamp) const {
  Grid grid;
  grid.stamp = stamp;
  grid.resolution = lattice().resolution;
  grid.width = static_cast<std::uint32_t>(high.x - low.x + 1);
  grid.height = static_cast<std::uint32_t>(high.y - low.y + 1);
  grid.origin.position = {lattice().left + low.x * lattice().resolution,
                          lattice().bottom + low.y * lattice().resolution, 0};
  grid.cells.reserve(std::size_t{grid.width} * grid.height);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      const Cell cell{x, y};
      grid.cells.push_back(lattice().contains(cell) ? cells_[cell] : kUnknown);
    }
  }
  return grid;
}

Cloud RobotMap::take_new_points(double stamp) {
  Cloud cloud;
  cloud.stamp = stamp;
  cloud.fields = {
      {"x", 0, kFloat32, 1}, {"y", 4, kFloat32, 1}, {"z", 8, kFloat32, 1}, {"intensity", 12, kFloat32, 1}};
  cloud.point_step = kValues * sizeof(float);
  cloud.data.resize(points_.size() * sizeof(float));
  if (!points_.empty()) std::memcpy(cloud.data.data(), points_.data(), cloud.data.size());
  points_.clear();
  return cloud;
}

}  // namespace adit::robots
