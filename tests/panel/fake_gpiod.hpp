#pragma once

#include <map>
#include <string>
#include <vector>

namespace adit::panel {

/// What stands behind the fake libgpiod: one chip, "gpiochip0", and its lines by name.
struct FakeLine {
  bool requested = false;
  bool active_low = false;
  std::string consumer;
  bool level = false;  // what the wire carries; an output keeps its last level after it is released
  int fails_with = 0;  // errno of setting it
};

struct FakeChip {
  std::map<std::string, FakeLine> lines;
  int open = 0;                      // how often it is open
  std::vector<std::string> history;  // "open", "request HEALTH", "release HEALTH", "close"
};

FakeChip& fake_chip();

}  // namespace adit::panel
