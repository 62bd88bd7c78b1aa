#pragma once

#include <cstdint>
#include <string>

#include "simulation/client.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// A client with broken software. It posts bad messages and expects the error status of each.
class Blunderer {
 public:
  Blunderer(World& world, int number);
  void post_until(double end);

 private:
  void post();

  World& world_;
  Random random_;
  Client client_;
  const double every_;
  double end_ = 0;
  std::int64_t serial_;
};

/// A client whose connection stalls within a request and is never closed.
class Staller {
 public:
  explicit Staller(World& world);
  void post_until(double end);

 private:
  void post();

  World& world_;
  Random random_;
  Client client_;
  double end_ = 0;
  std::int64_t serial_ = 0;
};

std::string status_request();

/// A client that asks for the status of the run.
class Watcher {
 public:
  Watcher(World& world, int number);
  void ask_until(double end);

 private:
  void ask();

  World& world_;
  Random random_;
  Client client_;
  const double every_;
  double end_ = 0;
};

}  // namespace adit::simulation
