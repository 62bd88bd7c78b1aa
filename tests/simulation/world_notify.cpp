// What host/service.hpp tells systemd, over the simulated world.
#include "host/service.hpp"
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

void notify_alive() {
  tell("WATCHDOG");
}

std::optional<std::chrono::microseconds> watchdog_within() {
  return kWatchdog;
}

}  // namespace adit::host
