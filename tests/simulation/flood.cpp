#include "simulation/flood.hpp"

#include "simulation/manners.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr std::uint64_t kMostFlooding = 40;
constexpr std::int64_t kFirstSerial = 20'000;

}  // namespace

Flood::Flood(World& world, double until)
    : world_(world), random_(world.random("flood")), clouds_(random_.chance(0.5)), serial_(kFirstSerial) {
  for (std::uint64_t i = 1 + random_.uniform_index(kMostFlooding); i > 0; --i) {
    clients_.push_back(std::make_unique<Client>(world, address(80), Manners{.patience = 8},
                                                world.random("flood " + std::to_string(i))));
  }
  world.after(seconds(random_.uniform(0, until)), [this] { begin(); });
}

void Flood::begin() {
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    world_.after(seconds(random_.uniform(0, 0.5)), [this, i] { post(i); });
  }
}

void Flood::post(std::size_t connection) {
  if (left_ == 0) return;
  --left_;
  const Posting posting = clouds_ ? Posting{kMap, {{.who = "flood", .serial = ++serial_, .says = {200}}}}
                                  : Posting{kState, {{.who = "flood", .serial = ++serial_}}};
  clients_[connection]->ask(
      request_of(posting, {.cbor = true, .point_step = 256}),
      {.what = posting.path, .who = "flood", .serial = serial_, .says = posting.items[0].says},
      [this, connection](int) { post(connection); });
}

}  // namespace adit::simulation
