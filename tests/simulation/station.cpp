#include "simulation/station.hpp"

#include <utility>

#include "simulation/manners.hpp"
#include "simulation/robot.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr std::int64_t kFirstSerial = 24'000;
constexpr int kPlanner = 91;            // of its address, if it has its own
constexpr int kFew = 100, kMany = 300;  // namespaces
constexpr Manners kManners{.keeps_alive = true, .patience = 30};

}  // namespace

Station::Station(World& world, double end)
    : world_(world),
      random_(world.random("station")),
      style_{.cbor = random_.chance(0.5), .gzip = random_.chance(0.3)},
      end_(end),
      clock_(random_.uniform(-1000, 1000)),
      every_(random_.uniform(0.1, 1)),
      clients_{Client(world, address(kNumber), kManners, world.random("first client of the station")),
               Client(world, address(kNumber), kManners, world.random("second client of the station"))},
      planner_(world, address(random_.chance(0.5) ? kNumber : kPlanner), kManners,
               world.random("client of the planner")),
      namespaces_(kFew + static_cast<int>(random_.uniform_index(kMany))),
      serial_(kFirstSerial) {
  robots_.push_back({"S1", end});
  robots_.push_back({"S2", random_.uniform(0, end)});
  if (random_.chance(0.5)) robots_.push_back({"S3", random_.uniform(0, end)});
  if (random_.chance(0.3)) robots_.push_back({"R1", random_.uniform(0, end)});  // it also posts by itself
  world.after(seconds(random_.uniform(0, end / 4)), [this] { begin(); });
  if (random_.chance(0.5)) world.after(seconds(random_.uniform(0, end)), [this] { plan(); });
}

Posting Station::states(bool all) {
  const double now = world_.time(), stamp = random_.chance(0.05) ? 0 : World::kEpoch + now + clock_;
  Posting posting{kState, {}};
  for (const Seen& robot : robots_) {
    if (robot.until >= now || all) posting.items.push_back({robot.name, ++serial_, stamp, {kNumber}});
  }
  if (!all && !posting.items.empty() && random_.chance(0.6))
    posting.items = {posting.items[random_.uniform_index(posting.items.size())]};
  return posting;
}

/// Adit learns its clock from its first message, so no other message is in flight then.
void Station::begin() {
  if (world_.time() > end_) return;
  world_.after(seconds(kLate), [this, posting = states(true)] {
    clients_[0].ask_several(request_of(posting, style_), events_of(posting), [this](int status) {
      if (status != 200) return world_.after(seconds(every_), [this] { begin(); });
      post(0);
      post(1);
    });
  });
}

void Station::post(std::size_t connection) {
  if (world_.time() > end_) return;
  Posting posting = states(false);
  if (posting.items.empty()) return;
  const double late = random_.uniform(0, kLate), pause = every_ * random_.uniform(0.2, 1.8);
  world_.after(seconds(late), [this, connection, pause, posting = std::move(posting)] {
    clients_[connection].ask_several(request_of(posting, style_), events_of(posting),
                                     [this, connection, pause](int) {
                                       world_.after(seconds(pause), [this, connection] { post(connection); });
                                     });
  });
}

void Station::plan() {
  Posting posting{kMarkers, {}};
  const double now = World::kEpoch + world_.time() + clock_;
  for (int i = 0; i < namespaces_; ++i) {
    posting.items.push_back(
        {"plan " + std::to_string(i), ++serial_, now, {random_.chance(0.5) ? kAdd : kDelete, 0, 0}});
  }
  planner_.ask_several(request_of(posting, style_), events_of(posting), [](int) {});
}

}  // namespace adit::simulation
