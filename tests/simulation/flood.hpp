#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/client.hpp"
#include "simulation/messages.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// A fleet behind one address: fifty states within a second, or clouds, on up to 40 connections at once.
class Flood {
 public:
  Flood(World& world, double until);

 private:
  void begin();
  void post(std::size_t connection);

  World& world_;
  Random random_;
  std::vector<std::unique_ptr<Client>> clients_;
  const bool clouds_;
  int left_ = 50;
  std::int64_t serial_;
};

}  // namespace adit::simulation
