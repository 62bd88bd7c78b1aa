#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "rehearsal/robots/dated.hpp"
#include "rehearsal/robots/http.hpp"

namespace adit::robots {

/// How much of its maps each robot posted, whatever was answered: what a rehearsal Command Post measures
/// against. Any thread may write to it.
class Posted {
 public:
  struct Amount {
    std::uint64_t amount = 0;  // cells or points posted so far, each counted once
    std::uint64_t places = 0;  // that have points (KnownPlaces); of grids 0
    Moment newest;             // the last map's date
  };
  void note(const std::string& robot, Kind kind, const Amount& amount);

  /// As POST /posted on the control port takes it.
  std::string json() const;

 private:
  mutable std::mutex mutex_;  // guards all below
  std::map<std::pair<std::string, Kind>, Amount> amounts_;
};

/// Tells the rehearsal Command Post's control port what was posted. How old that was when it came and how
/// much of it is there, as a table; or a line that says why there is none.
std::string arrivals_of(const Posted& posted, const Endpoint& control);

}  // namespace adit::robots
