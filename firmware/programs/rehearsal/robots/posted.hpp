#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "rehearsal/robots/http.hpp"
#include "rehearsal/robots/map_maker.hpp"
#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// The amount of map data and the markers that each robot posted, rejected posts included. A rehearsal
/// Command Post compares them with its own. Any thread may write to it.
class Posted {
 public:
  struct Amount {
    std::uint64_t amount = 0;  // cells or points posted so far, each counted once
    std::uint64_t places = 0;  // that have points (KnownPlaces); of grids 0
    Moment newest;             // the last map's date
  };
  void note(const std::string& robot, Kind kind, const Amount& amount);
  /// The robot's markers after its last post.
  void note(const std::string& robot, const std::vector<Marker>& standing);

  /// As POST /posted on the control port takes it.
  std::string json() const;

 private:
  mutable std::mutex mutex_;  // guards all below
  std::map<std::pair<std::string, Kind>, Amount> amounts_;
  std::map<std::string, std::vector<Marker>> standing_;  // by robot
};

/// Tells the rehearsal Command Post's control port what was posted. How old that was when it came and how
/// much of it is there, as a table; or a line that says why there is none.
std::string arrivals_of(const Posted& posted, const Endpoint& control);

}  // namespace adit::robots
