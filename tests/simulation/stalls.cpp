#include "simulation/stalls.hpp"

#include "simulation/world.hpp"

namespace adit::simulation {

void Stalls::plan(double trouble_for) {
  Random random = world_.random("stalls");
  for (std::uint64_t i = random.chance(0.25) ? 1 + random.uniform_index(2) : 0; i > 0; --i) {
    const double begins = random.uniform(0, trouble_for);
    const double length = std::min(random.uniform(1, 20), trouble_for - begins);
    if (world_.omits("stalls")) continue;
    world_.after(seconds(begins), [this, length] { begin(length); });
  }
}

bool Stalls::is_on() const {
  return world_.now() < ends_;
}

void Stalls::begin(double length) {
  if (is_on()) return;
  ends_ = world_.now() + seconds(length);
  length_ = length;
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = "begins", .who = "Stall"});
  world_.after(seconds(length), [this] {
    world_.note({.actor = Actor::Post, .kind = Kind::Mended, .what = "", .who = "Stall"});
  });
}

}  // namespace adit::simulation
