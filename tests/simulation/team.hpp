#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/client.hpp"
#include "simulation/random.hpp"
#include "simulation/robot.hpp"

namespace adit::simulation {

class World;

/// Somebody who reports artifacts, each until he hears that it is recorded.
class Reporter {
 public:
  Reporter(World& world, int number);
  void report_until(double end);

 private:
  void report();
  void answered(int status);

  World& world_;
  Random random_;
  Client client_;
  const int number_;
  const double every_;
  double end_ = 0;
  std::int64_t serial_;
  int tries_ = 0;
};

/// All of them.
class Team {
 public:
  Team(World& world, double until);

 private:
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<std::unique_ptr<Reporter>> reporters_;
};

}  // namespace adit::simulation
