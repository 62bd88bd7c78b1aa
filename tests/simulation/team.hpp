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

/// A robot: posts where it is, its grid and a marker, each newer than the one before.
class Robot {
 public:
  Robot(World& world, int number);
  /// Until then, on the run's clock.
  void post_until(double end);

 private:
  void post();

  World& world_;
  Random random_;
  const std::string name_;
  Client client_;
  const Style style_;
  const double clock_;  // seconds by which its clock is off
  const bool stamps_;
  const double every_;  // seconds between two messages, about
  double end_ = 0;
  std::int64_t serial_ = 0;
  int size_ = 8;
};

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
