#pragma once

#include "settings/settings.hpp"

namespace adit::settings {

/// What of a running gateway restarts where other settings take the place of its own. All that is not
/// named here goes on, and takes over the values.
struct Restarts {
  bool listeners = false;  // where the team is served
  bool scoring = false;    // the endpoint: its connection, and what is known of the run there
  bool mapping = false;    // the endpoint: its connections
  bool panel = false;      // the lines of the lights and the button
  friend bool operator==(const Restarts&, const Restarts&) = default;
};

/// `running`, `next`: as in_use() gives them.
Restarts restarts_by(const Settings& running, const Settings& next);

}  // namespace adit::settings
