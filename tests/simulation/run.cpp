#include "simulation/run.hpp"

#include <algorithm>

#include "simulation/box.hpp"
#include "simulation/checks.hpp"
#include "simulation/courses.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/ledger_reading.hpp"
#include "simulation/operator.hpp"
#include "simulation/reader.hpp"
#include "simulation/team.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

/// Seconds after the last fault. kLeastRest is enough to send queued messages and for the operators'
/// decisions. kMostRest covers a robot that posts faster than its maps are sent.
constexpr double kLeastRest = 120, kMostRest = 1200;

/// In three of four runs: up to four ends of the process, by SIGTERM, SIGKILL or a power cut.
void plan_ends(World& world, Box& box, double trouble_for) {
  Random random = world.random("ends");
  for (std::uint64_t i = random.chance(0.25) ? 0 : 1 + random.uniform_index(4); i > 0; --i) {
    const double how = random.unit();
    const auto when = seconds(random.uniform(0.5, trouble_for));
    if (world.omits("ends")) continue;
    world.after(when, [&box, how] {
      if (how < 0.3) return box.terminate();
      box.die(how < 0.7 ? World::How::Killed : World::How::PowerCut);
    });
  }
}

/// In three of ten runs: the box's clock is set up to three times, forward or back, by seconds or by
/// months.
void plan_clock(World& world, double trouble_for) {
  Random random = world.random("clock");
  if (!random.chance(0.3)) return;
  for (std::uint64_t i = 1 + random.uniform_index(3); i > 0; --i) {
    // A step of less than half a second has no effect.
    const double by = random.uniform(1, random.chance(0.5) ? 8 : 1e7);
    const double step = random.chance(0.5) ? by : -by;
    const auto when = seconds(random.uniform(0, trouble_for));
    if (world.omits("clock")) continue;
    world.after(when, [&world, step] { world.set_clock(world.clock_ahead() + step); });
  }
}

/// Ends the process before each start that a fault is to hit.
void plan_calls(World& world, Box& box, double trouble_for) {
  CallFaults& calls = world.disk().calls();
  calls.plan(trouble_for);
  Random random = world.random("ends for calls");
  for (const double end : calls.ends()) {
    const bool is_killed = random.chance(0.5);
    world.after(seconds(end),
                [&box, is_killed] { is_killed ? box.die(World::How::Killed) : box.terminate(); });
  }
}

/// In a fifth of the runs: once or twice a person copies the ledger, and later, between two processes, puts
/// the copy back.
void plan_older_copies(World& world, Box& box, double trouble_for) {
  Random random = world.random("older copies");
  if (!random.chance(0.2)) return;
  for (std::uint64_t i = 1 + random.uniform_index(2); i > 0; --i) {
    const double one = random.uniform(0, trouble_for), other = random.uniform(0, trouble_for);
    const double how = random.unit();
    if (world.omits("older copies")) continue;
    world.after(seconds(std::min(one, other)), [&box] { box.copy_ledger(); });
    world.after(seconds(std::max(one, other)), [&world, &box, how] {
      box.put_ledger_back();
      if (world.is_dead()) return;
      if (how < 0.2) return box.terminate();
      box.die(how < 0.5 ? World::How::Killed : World::How::PowerCut);
    });
  }
}

}  // namespace

Outcome play(const Plan& plan) {
  World world(plan.seed, plan.without);
  world.history().tells = plan.tells;
  Box box(world);
  const double trouble_for = world.random("length").uniform(10, 60);
  const Faults faults(world.random("faults"));
  Courses posts(world, faults, trouble_for);
  world.network().serve(&posts);
  const Team team(world, trouble_for);
  const Operator operator_(world, box, trouble_for);
  const DecidingOperator deciding_operator(world, trouble_for);
  const Switcher switcher(world, trouble_for);
  Reader reader(world, trouble_for);
  plan_ends(world, box, trouble_for);
  plan_clock(world, trouble_for);
  world.disk().faults().plan(trouble_for);
  plan_calls(world, box, trouble_for);
  plan_older_copies(world, box, trouble_for);
  world.network().stalls().plan(trouble_for);
  world.after(seconds(trouble_for), [&] { posts.calm(); });
  reader.wait_for_rest(trouble_for + kLeastRest, trouble_for + kMostRest, [&] { box.finish(); });
  box.live();
  const LedgerReading ledger = read_ledger(box.state() + "/ledger");
  return {.hash = world.history().hash(),
          .seconds = world.time(),
          .steps = world.steps(),
          .faults = world.history().faults(),
          .drawn = faults.names() + world.disk().faults().names() + world.disk().calls().names(),
          .broken = all_checks({world.history().events(), ledger.reports, reader.readings(),
                                box.most_map_bytes(), ledger.missing}),
          .actions = world.actions()};
}

}  // namespace adit::simulation
