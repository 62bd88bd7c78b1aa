#include "rehearsal/command_post/stamp_order.hpp"

#include <algorithm>

#include "rehearsal/command_post/json.hpp"

namespace adit::rehearsal {

void StampOrder::check(const std::string& uri, const std::vector<Stamp>& stamps, bool taken_anyhow,
                       Findings& findings) {
  const std::lock_guard lock(mutex_);
  double latest = latest_[uri];  // stamps are not negative
  bool forward = true;
  for (const Stamp& stamp : stamps) {
    if (stamp.seconds < latest && forward) {
      forward = false;
      findings.breaks(stamp.path + ": runs backward, " + line_of(Json(stamp.seconds)) + " after " +
                          line_of(Json(latest)) + " (ICD 6.2)",
                      Measured::Takes);
    }
    latest = std::max(latest, stamp.seconds);
  }
  if (forward || taken_anyhow) latest_[uri] = latest;
}

}  // namespace adit::rehearsal
