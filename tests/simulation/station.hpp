#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/client.hpp"
#include "simulation/messages.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// Posts the poses of several robots, singly or together, stamped by one clock that runs as the world's.
/// Each message leaves some time after its stamp, on one of two connections, so messages overtake each
/// other. The robots fall silent one after the other. In some runs a planner beside it posts markers of
/// very many namespaces.
class Station {
 public:
  static constexpr int kNumber = 90;    // of its address
  static constexpr double kLate = 0.8;  // maximum delay in seconds, and the delay of its first message

  /// Posts until `end`. `world` must outlive it.
  Station(World& world, double end);

 private:
  struct Seen {
    std::string name;
    double until = 0;
  };
  Posting states(bool all);
  void begin();
  void post(std::size_t connection);
  void plan();

  World& world_;
  Random random_;
  const Style style_;
  const double end_, clock_, every_;
  std::array<Client, 2> clients_;
  Client planner_;
  const int namespaces_;  // per message
  std::vector<Seen> robots_;
  std::int64_t serial_;
};

}  // namespace adit::simulation
