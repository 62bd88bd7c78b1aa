#include "rehearsal/robots/robot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "rehearsal/robots/route.hpp"

namespace adit::robots {

Robot::Robot(const Cave& cave, std::uint64_t seed, std::size_t index)
    : cave_(cave),
      random_(seed * 1'000'003 + index),
      map_(cave.lattice()),
      x_(0.4 * static_cast<double>(index % 3)),
      y_(0.4 * static_cast<double>(index / 3 % 3)),
      yaw_(0),
      preferred_(std::numbers::pi / 3 * (static_cast<double>((index + 1) % 3) - 1)),
      noticed_(cave.artifacts().size(), false) {
  map_.sweep(cave_, pose().position, random_);
  map_.sweep(cave_, pose().position, random_);
  notice();
}

Placement Robot::pose() const {
  const double z = cave_.floor_at(cave_.lattice().cell_at(x_, y_)) + 0.4;
  return {.position = {x_, y_, z}, .orientation = rotation_of(yaw_)};
}

void Robot::step(double metres) {
  const Lattice& lattice = cave_.lattice();
  while (metres > 0) {
    if (way_.empty()) {
      way_ = way_to_explore(map_, lattice.cell_at(x_, y_), preferred_, random_);
      std::ranges::reverse(way_);
      if (way_.empty()) return;  // it stands still until it sees a way
    }
    const double dx = lattice.centre_x(way_.back()) - x_, dy = lattice.centre_y(way_.back()) - y_;
    const double far = std::hypot(dx, dy);
    if (far <= metres) {
      x_ += dx;
      y_ += dy;
      way_.pop_back();
    } else {
      x_ += dx / far * metres;
      y_ += dy / far * metres;
    }
    if (far > 1e-9) yaw_ = std::atan2(dy, dx);
    walked_ += std::min(far, metres);
    metres -= far;
  }
}

void Robot::advance(double metres) {
  // What is new in sight may have made the goal pointless; the way itself stays walkable in a still cave.
  if (!way_.empty() && !is_frontier(map_, way_.front()) && random_.chance(0.2)) way_.clear();
  step(metres);
  map_.sweep(cave_, pose().position, random_);
  notice();
}

void Robot::notice() {
  const Vector3 here = pose().position;
  for (std::size_t i = 0; i < cave_.artifacts().size(); ++i) {
    const Vector3& there = cave_.artifacts()[i].position;
    if (noticed_[i] || std::hypot(there.x - here.x, there.y - here.y) > kSightRange) continue;
    if (!cave_.in_sight(here, there)) continue;
    noticed_[i] = true;
    sightings_.push_back(i);
  }
}

std::vector<std::size_t> Robot::take_sightings() {
  return std::exchange(sightings_, {});
}

}  // namespace adit::robots
