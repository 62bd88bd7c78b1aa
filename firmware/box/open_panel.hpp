#pragma once

#include <string>

#include "loop/file_descriptor.hpp"
#include "panel/held.hpp"
#include "settings/board.hpp"

namespace adit::box {

/// What the board's file says.
struct KnownBoard {
  settings::Board board;  // empty where there is none
  std::string trouble;    // why it does not count; or ""
};
/// `file` may be "", and need not be there.
KnownBoard read_board(const std::string& file);

/// Where the panel is, other than at the lines of the settings.
struct PanelPlace {
  std::string socket;  // of adit-panel, which holds the lines; "": nobody does
  std::string folder;  // of a simulated panel
};
/// The panel that adit-panel holds. Where nobody does, what this program holds itself, with the file `panel`
/// of the folder as the simulated one. `announced`: panel::announce(), or empty.
panel::Held open_panel(const settings::Panel& settings, const PanelPlace& place,
                       loop::FileDescriptor announced = {});

}  // namespace adit::box
