#include "simulation/disk_faults.hpp"

#include <utility>

#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr const char* kDiskFaults[] = {"Full", "SyncFails", "ReadOnly", "Slow", "RuntimeFull", "Unreadable"};
constexpr double kSlowest = 5;  // seconds that a sync takes

}  // namespace

DiskFaults::DiskFaults(World& world)
    : world_(world), random_(world.random("disk faults")), delays_(random_) {}

void DiskFaults::plan(double trouble_for) {
  const std::uint64_t kinds = random_.chance(0.5) ? 0 : 1 + random_.uniform_index(2);
  for (std::uint64_t i = 0; i < kinds; ++i) {
    const auto kind = static_cast<Kind>(random_.uniform_index(static_cast<std::uint64_t>(Kind::Unreadable)));
    names_.append(names_.empty() ? "; disk: " : " ").append(kDiskFaults[static_cast<int>(kind)]);
    for (std::uint64_t times = 1 + random_.uniform_index(2); times > 0; --times) plan(kind, trouble_for);
  }
  if (!world_.random("unreadable").chance(0.1)) return;
  names_.append(names_.empty() ? "; disk: " : " ").append("Unreadable");
  plan(Kind::Unreadable, trouble_for);
}

/// A fault may begin with the run.
void DiskFaults::plan(Kind kind, double trouble_for) {
  const bool at_once = random_.chance(0.2);
  const double begins = at_once ? 0 : random_.uniform(0, trouble_for);
  const double ends = std::min(trouble_for, begins + random_.uniform(0.5, 15));
  const Drawn drawn = {.fails_once = random_.chance(0.5),
                       .room = random_.chance(0.5) ? 0 : random_.uniform_index(20000),
                       .delays = world_.random("slow disk " + std::to_string(++planned_))};
  if (world_.omits(kDiskFaults[static_cast<int>(kind)])) return;
  if (at_once) {
    begin(kind, drawn);
  } else {
    world_.after(seconds(begins), [this, kind, drawn] { begin(kind, drawn); });
  }
  world_.after(seconds(ends), [this, kind] { end(kind); });
}

void DiskFaults::begin(Kind kind, const Drawn& drawn) {
  const auto index = static_cast<int>(kind);
  is_[index] = true;
  if (kind == Kind::SyncFails) fails_once_ = drawn.fails_once;
  if (kind == Kind::Slow) delays_ = drawn.delays;
  if (kind == Kind::Full || kind == Kind::RuntimeFull) room_[kind == Kind::RuntimeFull ? 1 : 0] = drawn.room;
  world_.note(
      {.actor = Actor::Disk, .kind = simulation::Kind::Fault, .what = "begins", .who = kDiskFaults[index]});
}

void DiskFaults::end(Kind kind) {
  const auto index = static_cast<int>(kind);
  if (!std::exchange(is_[index], false)) return;
  world_.note(
      {.actor = Actor::Disk, .kind = simulation::Kind::Mended, .what = "", .who = kDiskFaults[index]});
}

bool DiskFaults::sync_fails() {
  if (!is(Kind::SyncFails)) return false;
  if (fails_once_) end(Kind::SyncFails);
  return true;
}

double DiskFaults::sync_takes() {
  return is(Kind::Slow) && delays_.chance(0.3) ? delays_.uniform(0.01, kSlowest) : 0;
}

}  // namespace adit::simulation
