#pragma once

#include "settings/settings.hpp"

namespace adit::settings {

/// The parts of a running gateway that restart for new settings. All others continue with the new values.
struct Restarts {
  bool listeners = false;  // the team's sockets
  bool scoring = false;    // the scoring connection, and the known state of the run
  bool mapping = false;    // the mapping connections
  bool panel = false;      // the lines of lights and button
  friend bool operator==(const Restarts&, const Restarts&) = default;
};

/// `running`, `next`: from in_use().
Restarts restarts_by(const Settings& running, const Settings& next);

}  // namespace adit::settings
