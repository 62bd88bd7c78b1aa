// Clouds without a setting: a worker finds those that newer ones contain.
#include <utility>

#include "forward/maps.hpp"
#include "pack/has_all_points.hpp"

namespace adit::forward {

/// One pair at a time, to save memory. Both stay queued and may be sent.
void Maps::compare() {
  if (comparing_ || stopping_) return;
  auto next = queue_.to_compare();
  if (!next) return;
  struct Comparison {
    queues::Successive two;
    bool has_all = false;
  };
  const auto it = std::make_shared<Comparison>(Comparison{*std::move(next)});
  workers_.submit(
      loop::Urgency::OnTheWay,
      [it] { it->has_all = pack::has_all_points(it->two.newer, it->two.older, it->two.point_step); },
      [this, it] { compared(it->two, it->has_all); });
  comparing_ = true;
}

void Maps::compared(const queues::Successive& two, bool has_all) {
  comparing_ = false;
  const Traffic traffic{Kind::Cloud, two.sender.name ? two.sender.name->text() : ""};
  if (has_all) {
    const auto replaced = queue_.replace(two);
    record_.replaced(traffic, replaced.size());
    forget(replaced);
  } else {
    queue_.keep_both(two);
  }
  record_.clouds_are(traffic, has_all ? queues::Clouds::Whole : queues::Clouds::Parts);
  compare();
}

/// All points were accepted before. If that was forgotten, the cloud is packed again.
void Maps::is_there(Place& place) {
  const LeftOut& left_out = place->packed.left_out;
  if (!points_.hold(left_out)) return;
  const auto there = std::exchange(place, nullptr);
  const Traffic traffic = traffic_of(there->waiting.map);
  record_.left_out(traffic, there->packed.left_out.points);
  record_.replaced(traffic, there->waiting.updates.size());
  forget(there->waiting.updates);
}

/// Keeps only the points that were sent.
void Maps::points_taken(Prepared& sent) {
  icd::MapUpdate& map = sent.waiting.map;
  LeftOut& left_out = sent.packed.left_out;
  record_.left_out(traffic_of(map), left_out.points);
  if (left_out.sent) {
    left_out.sent->header() = map.header();
    map = *std::exchange(left_out.sent, std::nullopt);
  }
  points_.taken(map, std::move(left_out));
}

/// Delivered, but the points left out were forgotten since.
void Maps::goes_whole(const Place& sent, int status) {
  record_.forwarded(traffic_of(sent->waiting.map), 0, sent->packed.body.size(), status, loop_.wall_now());
  again(sent);
}

}  // namespace adit::forward
