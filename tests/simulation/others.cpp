#include "simulation/others.hpp"

#include <string>

#include "simulation/bad_messages.hpp"
#include "simulation/manners.hpp"
#include "simulation/messages.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr std::int64_t kSerialsOfOne = 1000;

}  // namespace

std::string status_request() {
  return http_request("GET", kStatus, "Host: 10.0.0.1\r\nAuthorization: Bearer token-of-the-team\r\n", "");
}

Blunderer::Blunderer(World& world, int number)
    : world_(world),
      random_(world.random("blunderer " + std::to_string(number))),
      client_(world, address(50 + number), manners(random_),
              world.random("client of blunderer " + std::to_string(number))),
      every_(random_.uniform(0.3, 5)),
      serial_(kBadSerials + number * kSerialsOfOne) {}

void Blunderer::post_until(double end) {
  end_ = end;
  world_.after(seconds(random_.uniform(0, every_)), [this] { post(); });
}

void Blunderer::post() {
  if (world_.time() > end_) return;
  const BadMessage bad = bad_message(random_, ++serial_);
  client_.ask(bad.request,
              {.what = bad.path, .who = "bad", .serial = serial_, .status = bad.status, .text = bad.what},
              [this](int) { world_.after(seconds(every_ * random_.uniform(0.2, 1.8)), [this] { post(); }); });
}

Staller::Staller(World& world)
    : world_(world),
      random_(world.random("staller")),
      client_(world, address(70), {.keeps_alive = random_.chance(0.5), .patience = 90, .stalls = 0.7},
              world.random("client of the staller")) {}

void Staller::post_until(double end) {
  end_ = end;
  world_.after(seconds(random_.uniform(0, end)), [this] { post(); });
}

void Staller::post() {
  if (world_.time() > end_) return;
  const Posting posting =
      random_.chance(0.5) ? Posting{kState, {{.who = "stalled", .serial = ++serial_}}}
                          : Posting{kMap, {{.who = "stalled", .serial = ++serial_, .says = Extent{}.says()}}};
  client_.ask(request_of(posting, {}),
              {.what = posting.path, .who = "stalled", .serial = serial_, .says = posting.items[0].says},
              [this](int) { world_.after(seconds(random_.uniform(0, 2)), [this] { post(); }); });
}

Watcher::Watcher(World& world, int number)
    : world_(world),
      random_(world.random("watcher " + std::to_string(number))),
      client_(world, address(60 + number), manners(random_),
              world.random("client of watcher " + std::to_string(number))),
      every_(random_.uniform(0.1, 4)) {}

void Watcher::ask_until(double end) {
  end_ = end;
  world_.after(seconds(random_.uniform(0, every_)), [this] { ask(); });
}

void Watcher::ask() {
  if (world_.time() > end_) return;
  client_.ask(status_request(), {.what = kStatus, .who = "watcher"},
              [this](int) { world_.after(seconds(every_ * random_.uniform(0.2, 1.8)), [this] { ask(); }); });
}

}  // namespace adit::simulation
