#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "rehearsal/command_post/findings.hpp"
#include "rehearsal/command_post/geometry.hpp"

namespace adit::rehearsal {

/// ICD 6.2: the stamps of a URI never run backward, within a message and from one to the next; equal ones are
/// fine. Safe for use by several threads.
class StampOrder {
 public:
  /// Writes down the first stamp that is before one that came earlier. A message that passes, or that is
  /// taken all the same (`taken_anyhow`), counts from then on.
  void check(const std::string& uri, const std::vector<Stamp>& stamps, bool taken_anyhow, Findings& findings);

 private:
  std::mutex mutex_;
  std::map<std::string, double> latest_;
};

}  // namespace adit::rehearsal
