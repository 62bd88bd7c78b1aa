#pragma once

#include <compare>
#include <optional>

#include "icd/map_update.hpp"

namespace adit::queues {

/// A sender in Turns: the maps of one robot and one kind.
struct Sender {
  std::optional<icd::RobotName> name;  // absent: merged maps of all robots
  bool is_grid = false;
  static Sender of(const icd::MapUpdate& map) { return {map.name, map.is_grid()}; }
  friend auto operator<=>(const Sender&, const Sender&) = default;
};

}  // namespace adit::queues
