#pragma once

#include <cstddef>
#include <mutex>
#include <set>
#include <vector>

#include "rehearsal/command_post/findings.hpp"
#include "rehearsal/command_post/messages.hpp"

namespace adit::rehearsal {

/// The organiser's display of markers, as measured: after a message with fewer markers than the one before,
/// its server deletes the markers with an empty `ns` whose ids are the numbers that are missing. Safe for use
/// by several threads.
class MarkerDisplay {
 public:
  /// Writes down each marker that this deletes and that stands.
  void show(const std::vector<MarkerChange>& changes, Findings& findings);

 private:
  std::mutex mutex_;
  std::set<std::int64_t> unnamed_;  // the ids that stand with an empty ns
  std::size_t before_ = 0;          // markers of the message before
};

}  // namespace adit::rehearsal
