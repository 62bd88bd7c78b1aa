#pragma once

#include <vector>

#include "rehearsal/robots/robot_map.hpp"

namespace adit::robots {

/// Whether the robot's body fits: the cell is free and no cell beside it is rock.
bool is_walkable(const RobotMap& map, Cell cell);

/// Whether what lies beside a walkable cell is not known yet.
bool is_frontier(const RobotMap& map, Cell cell);

/// The way from `start`, over walkable cells wherever it can, to the best frontier: near, and in the
/// direction `heading` (radians) that this robot prefers, so that a team spreads out. Where nothing is left
/// to explore, the way to some place that `random` chooses. Empty where there is no way anywhere.
std::vector<Cell> way_to_explore(const RobotMap& map, Cell start, double heading, Random& random);

}  // namespace adit::robots
