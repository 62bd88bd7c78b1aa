#pragma once

#include <string>

#include "loop/file_descriptor.hpp"
#include "panel/held.hpp"
#include "settings/board.hpp"

namespace adit::box {

/// Contents of the board's file.
struct KnownBoard {
  settings::Board board;  // empty without a file
  std::string trouble;    // why the file is ignored, or ""
};
/// `file` may be "" or absent.
KnownBoard read_board(const std::string& file);

/// The panel's place, if not the lines in the settings.
struct PanelPlace {
  std::string socket;  // adit-panel's socket; "": not used
  std::string folder;  // of a simulated panel
};
/// adit-panel's panel, or one that this process holds. The simulated panel is the file `panel` in the folder.
/// `announced`: panel::announce(), or empty.
panel::Held open_panel(const settings::Panel& settings, const PanelPlace& place,
                       loop::FileDescriptor announced = {});

}  // namespace adit::box
