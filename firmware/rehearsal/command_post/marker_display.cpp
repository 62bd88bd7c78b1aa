#include "rehearsal/command_post/marker_display.hpp"

#include <string>
#include <utility>

namespace adit::rehearsal {
namespace {

constexpr int kDelete = 2, kDeleteAll = 3;

}  // namespace

void MarkerDisplay::show(const std::vector<MarkerChange>& changes, Findings& findings) {
  if (changes.empty()) return;
  const std::lock_guard lock(mutex_);
  for (const MarkerChange& change : changes) {
    if (change.action == kDeleteAll) unnamed_.clear();
    if (!change.ns.empty()) continue;
    if (change.action == kDelete) unnamed_.erase(change.id);
    if (change.action == 0) unnamed_.insert(change.id);
  }
  for (std::size_t id = changes.size(); id < before_; ++id) {
    if (unnamed_.erase(static_cast<std::int64_t>(id)) == 0) continue;
    findings.breaks("markers: the organiser's display deletes id " + std::to_string(id) +
                        " of an empty ns, for this message has fewer markers than the one before",
                    Measured::Takes);
  }
  before_ = changes.size();
}

}  // namespace adit::rehearsal
