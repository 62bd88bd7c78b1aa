#pragma once

#include <string>

#include "simulation/box.hpp"
#include "simulation/client.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// Saves settings by the page's API, whereupon the gateway begins anew within its process.
class Operator {
 public:
  /// Logged in from the beginning. Both outlive this.
  Operator(World& world, const Box& box, double until);

 private:
  void save();

  World& world_;
  const Box& box_;
  Client client_;
  std::string id_, csrf_;
};

}  // namespace adit::simulation
