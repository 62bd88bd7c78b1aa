#pragma once

#include <string>
#include <vector>

#include "simulation/history.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {

/// Seconds in which what nobody waits for any more may still be accepted: it may stand at the door until the
/// next life begins, and be read by it.
constexpr double kForgotten = 12;

/// One request of a client, and what became of it. Where the client heard nothing it is unknown: it may have
/// counted at any time from when it began until it ended, or never.
struct Asked {
  std::string path;
  std::vector<Item> items;
  double began = 0;
  double ended = 0;  // after this it is not accepted any more
  bool whole = false;
  int status = 0;  // 0: the client heard nothing

  bool accepted() const { return status == 200; }
  bool may_count() const { return accepted() || (status == 0 && whole); }
};

/// Those of that path, but for bad messages, in the order in which they began.
std::vector<Asked> asked_in(const std::vector<Event>& events, const std::string& path);

}  // namespace adit::simulation
