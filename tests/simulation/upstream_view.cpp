#include "simulation/upstream_view.hpp"

#include <cstdlib>

#include "simulation/messages.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {

void UpstreamView::left(std::string_view bytes) {
  World& world = World::current();
  if (requests_.is_between()) {
    const std::size_t from = bytes.find(' ') + 1;
    path_ = bytes.substr(from, bytes.find(' ', from) - from);
    world.note({.kind = Kind::Leaves, .what = path_, .who = ""});
  }
  requests_.feed(bytes);
  while (const auto request = requests_.next()) {
    for (const Item& item : items_of(*request)) {
      world.note(
          {.kind = Kind::Left, .what = path_, .who = item.who, .serial = item.serial, .stamp = item.stamp});
    }
  }
}

void UpstreamView::came(std::string_view bytes) {
  answers_.feed(bytes);
  while (const auto answer = answers_.next()) {
    World::current().note({.kind = Kind::Replied,
                           .what = path_,
                           .who = "",
                           .status = answer->status(),
                           .stamp = std::atof(answer->header("retry-after").c_str())});
  }
}

}  // namespace adit::simulation
