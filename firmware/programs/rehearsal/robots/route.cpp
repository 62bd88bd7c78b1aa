#include "rehearsal/robots/route.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace adit::robots {
namespace {

constexpr std::array<Cell, 8> kSteps = {Cell{1, 0}, Cell{0, 1},  Cell{-1, 0},  Cell{0, -1},
                                        Cell{1, 1}, Cell{-1, 1}, Cell{-1, -1}, Cell{1, -1}};

/// Breadth first: the cells in order of their distance, and from where each was reached.
struct Reach {
  std::vector<Cell> cells;
  Raster<int> steps;    // from the start; -1 where not reached
  Raster<int> reached;  // index in kSteps of the step that led there
};

Reach reach_from(const RobotMap& map, Cell start) {
  Reach reach{.cells = {start}, .steps = {map.lattice(), -1}, .reached = {map.lattice(), 0}};
  reach.steps[start] = 0;
  for (std::size_t next = 0; next < reach.cells.size(); ++next) {
    const Cell cell = reach.cells[next];
    // Rock seen since may have closed in on the robot; it squeezes out over whatever is free.
    const bool squeezed = !is_walkable(map, cell);
    for (std::size_t step = 0; step < kSteps.size(); ++step) {
      const Cell beside{cell.x + kSteps[step].x, cell.y + kSteps[step].y};
      if (!map.lattice().contains(beside) || reach.steps[beside] >= 0) continue;
      if (!is_walkable(map, beside) && !(squeezed && map.is_free(beside))) continue;
      reach.steps[beside] = reach.steps[cell] + 1;
      reach.reached[beside] = static_cast<int>(step);
      reach.cells.push_back(beside);
    }
  }
  return reach;
}

/// Metres to walk, and up to kDetour more for a place that lies the wrong way.
double cost(const Lattice& lattice, Cell start, Cell goal, int steps, double heading) {
  constexpr double kDetour = 12;
  const double direction = std::atan2(goal.y - start.y, goal.x - start.x);
  return steps * lattice.resolution + kDetour * (1 - std::cos(direction - heading)) / 2;
}

}  // namespace

bool is_walkable(const RobotMap& map, Cell cell) {
  if (!map.is_free(cell)) return false;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell beside{cell.x + dx, cell.y + dy};
      if (!map.lattice().contains(beside) || map.is_rock(beside)) return false;
    }
  }
  return true;
}

bool is_frontier(const RobotMap& map, Cell cell) {
  return std::ranges::any_of(kSteps, [&](Cell step) {
    const Cell beside{cell.x + step.x, cell.y + step.y};
    return map.lattice().contains(beside) && !map.is_known(beside);
  });
}

std::vector<Cell> way_to_explore(const RobotMap& map, Cell start, double heading, Random& random) {
  const Reach reach = reach_from(map, start);
  Cell goal = start;
  double cheapest = std::numeric_limits<double>::infinity();
  for (const Cell cell : reach.cells) {
    if (!is_frontier(map, cell) || !is_walkable(map, cell)) continue;
    const double price = cost(map.lattice(), start, cell, reach.steps[cell], heading);
    if (price < cheapest) {
      cheapest = price;
      goal = cell;
    }
  }
  if (goal == start) goal = reach.cells[random.below(reach.cells.size())];
  std::vector<Cell> way;
  for (Cell cell = goal; cell != start;) {
    way.push_back(cell);
    const Cell step = kSteps[static_cast<std::size_t>(reach.reached[cell])];
    cell = {cell.x - step.x, cell.y - step.y};
  }
  std::ranges::reverse(way);
  return way;
}

}  // namespace adit::robots
