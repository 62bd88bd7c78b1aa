#pragma once

#include "command_line/read.hpp"

namespace adit::panel {

/// adit-panel's command line.
struct PanelOptions {
  std::string board, socket, simulated;
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program panel_command_line_of(PanelOptions& options);

}  // namespace adit::panel
