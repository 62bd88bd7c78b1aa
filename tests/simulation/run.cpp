#include "simulation/run.hpp"

#include "simulation/box.hpp"
#include "simulation/command_post.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {

Outcome play(std::uint64_t seed, bool log) {
  World world(seed);
  world.history().tells = log;
  Box box(world);
  const double trouble_for = world.random("length").between(10, 60);
  CommandPost post(world, trouble_for);
  world.network().serve(&post);
  world.after(seconds(trouble_for), [&] { post.calm(); });
  world.after(seconds(trouble_for + 60), [&] { box.finish(); });
  box.live();
  return {.hash = world.history().hash(),
          .seconds = world.time(),
          .steps = world.steps(),
          .faults = world.history().faults(),
          .drawn = post.faults().names(),
          .broken = {}};
}

}  // namespace adit::simulation
