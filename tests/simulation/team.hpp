#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/client.hpp"
#include "simulation/flood.hpp"
#include "simulation/others.hpp"
#include "simulation/random.hpp"
#include "simulation/robot.hpp"
#include "simulation/station.hpp"
#include "simulation/unauthenticated_clients.hpp"

namespace adit::simulation {

class World;

/// Reports artifacts. Repeats each report until the answer says that it is recorded. Some reporters press
/// the button twice, and some repeat earlier reports.
class Reporter {
 public:
  Reporter(World& world, int number);
  void report_until(double end);

 private:
  void report();
  void report_too();
  void report_again();
  void answered(int status);

  World& world_;
  Random random_;
  Client client_, twin_;
  const double twins_;  // probability that a report is posted a second time before the first is answered
  Random repeating_;
  const double repeats_;  // probability that an earlier report is posted again after an answer
  const double every_;
  double end_ = 0;
  const std::int64_t first_;
  std::int64_t serial_;
  int tries_ = 0;
};

/// Posts a dozen reports at once, each on a connection of its own, while one of its clients asks for the
/// status every half second.
class Burst {
 public:
  Burst(World& world, double until);

 private:
  void begin();
  void watch();

  World& world_;
  Random random_;
  std::vector<std::unique_ptr<Client>> reporting_;
  Client watching_;
  double ends_ = 0;
};

/// In a third of the runs: reports once more, long after the trouble. The Command Post loses that answer.
class LateReporter {
 public:
  static constexpr std::int64_t kSerial = 8500;

  LateReporter(World& world, double trouble_for);

 private:
  void report();

  World& world_;
  Client client_;
};

class Team {
 public:
  Team(World& world, double until);

 private:
  std::vector<std::unique_ptr<Robot>> robots_;
  std::unique_ptr<Station> station_;  // may be null
  std::vector<std::unique_ptr<Reporter>> reporters_;
  LateReporter late_reporter_;
  std::vector<std::unique_ptr<Blunderer>> blunderers_;
  std::vector<std::unique_ptr<Watcher>> watchers_;
  std::vector<std::unique_ptr<Staller>> stallers_;
  std::vector<std::unique_ptr<Flood>> floods_;
  std::unique_ptr<Burst> burst_;  // may be null
  std::vector<std::unique_ptr<UnauthenticatedClients>> unauthenticated_;
};

}  // namespace adit::simulation
