#pragma once

#include <cstdint>

#include "simulation/client.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// Somebody whose software is broken: posts what the ICD forbids, and expects to hear so.
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

/// Somebody whose link breaks within a request, and never says so.
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

/// Somebody who asks how the run stands.
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
