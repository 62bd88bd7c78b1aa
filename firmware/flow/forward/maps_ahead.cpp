// How the next map goes ahead of the answer to the one before.
#include <algorithm>

#include "forward/maps.hpp"

namespace adit::forward {
namespace {

/// How the map before leaves is looked at no more often.
constexpr std::chrono::milliseconds kLookAtLeaving{10};
/// A connection for the next map is made so long before it may start, and the end of the one before is looked
/// for so often from then on: the link is idle in between.
constexpr std::chrono::milliseconds kGetReady{50}, kLookForEnd{2};

/// A Command Post may read both at the same time, and then check the small one before a large one that
/// arrived first. Its stamp would run backward. A slow one reads so many bytes of a map's data in a second.
constexpr double kReads = 20e6;

loop::Duration reading_takes(const icd::MapUpdate& map) {
  return std::chrono::duration_cast<loop::Duration>(
      std::chrono::duration<double>(static_cast<double>(map.data.raw_size) / kReads));
}

}  // namespace

/// Once the one that is under way has arrived; it is looked for when the next may start, and not before.
void Maps::go_ahead(loop::Instant now) {
  if (!may_go_ahead(now)) return;
  PreparedMap& first = *prepared_.first();
  const std::size_t size = first.packed.body.size(), left = size - std::min(size, channel_.sent_of_it());
  if (!first.arrived && left > 0)
    return wake_.call_at(now + std::max<loop::Duration>(prepared_.slot().transfer(left) / 2, kLookAtLeaving));
  if (now < starts() - kGetReady) return wake_.call_at(starts() - kGetReady);
  channel_.get_ready();
  const auto arrived = first.arrived ? std::nullopt : channel_.has_arrived();
  if (arrived) {
    first.arrived = arrived->last;
    pace_.left(*arrived);
  }
  loop::Instant begin = starts();
  if (first.arrived) begin = std::max(begin, *first.arrived + reading_takes(first.waiting.map));
  if (first.arrived && channel_.can_go_ahead() && now >= begin) return send(prepared_.following());
  wake_.call_at(std::max(begin, now + kLookForEnd));
}

/// If not, the answer to the one that is under way is awaited.
bool Maps::may_go_ahead(loop::Instant now) const {
  const PreparedMap& first = *prepared_.first();
  const queues::Pipelining::Before before{
      .map = first.waiting, .arrived = first.arrived.value_or(now), .went_ahead = first.went_ahead};
  return first.is_under_way && !channel_.is_serial() && pace_.may_go_ahead(now) &&
         ahead_.may_go(prepared_.following()->waiting, before, now);
}

}  // namespace adit::forward
