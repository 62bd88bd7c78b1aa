// Which clouds that wait are said by newer ones, where no setting tells: a worker looks.
#include "forward/maps.hpp"
#include "loop/guard.hpp"
#include "pack/has_all_points.hpp"

namespace adit::forward {

/// One pair after the other, so that this takes little of the workers and of memory. Meanwhile both wait, and
/// may go: nothing is lost by it.
void Maps::compare() {
  if (comparing_ || stopping_) return;
  loop::guarded("comparing clouds", [this] {
    auto next = lane_.to_compare();
    if (!next) return;
    struct Comparison {
      lanes::Successive two;
      bool has_all = false;
    };
    const auto it = std::make_shared<Comparison>(Comparison{*std::move(next)});
    workers_.submit(
        [it] { it->has_all = pack::has_all_points(it->two.newer, it->two.older, it->two.point_step); },
        [this, it] { compared(it->two, it->has_all); }, [this, it] { compared(it->two, false); });
    comparing_ = true;  // only now: where it could not be submitted, it is not
  });
}

void Maps::compared(const lanes::Successive& two, bool has_all) {
  comparing_ = false;
  const Traffic traffic{Kind::Cloud, two.sender.name ? two.sender.name->text() : ""};
  loop::guarded("clouds that were compared", [&] {
    if (has_all) {
      const auto replaced = lane_.replace(two);
      record_.replaced(traffic, replaced.size());
      forget(replaced);
    } else {
      lane_.keep_both(two);
    }
    record_.clouds_are(traffic, has_all ? lanes::Clouds::Whole : lanes::Clouds::Parts);
  });
  compare();
}

}  // namespace adit::forward
