// Implements host/systemd.hpp in the simulated world.
#include <cstdlib>
#include <utility>

#include "host/systemd.hpp"
#include "simulation/world.hpp"

namespace adit::host {
namespace {

using simulation::World;

constexpr std::chrono::seconds kWatchdog{10};  // services/adit.service: WatchdogSec

void tell(const char* what, const std::string& status = "") {
  World& world = World::current();
  if (world.is_dead()) return;
  world.note({.kind = simulation::Kind::Told, .what = what, .who = "", .text = status});
}

}  // namespace

void notify_ready(const std::string& status) {
  tell("READY");
  tell("STATUS", status);
}

void notify_status(const std::string& status) {
  tell("STATUS", status);
}

void notify_stopping() {
  tell("STOPPING");
}

void notify_restarting() {}

void notify_alive() {
  tell("WATCHDOG");
}

std::optional<std::chrono::microseconds> watchdog_interval() {
  return kWatchdog;
}

std::expected<std::vector<InheritedDescriptor>, std::string> inherited_sockets() {
  return std::exchange(World::current().inherited, {});
}
void store_descriptor(const std::string&, int) {}
void forget_descriptor(const std::string&) {}

void restart_process(std::vector<InheritedDescriptor> sockets, char* const*,
                     std::map<std::string, std::string> variables) {
  World& world = World::current();
  world.crossing();
  if (world.is_dead()) throw simulation::Killed{};
  for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
  world.inherited = std::move(sockets);
  throw simulation::StartsAgain{};
}

}  // namespace adit::host
