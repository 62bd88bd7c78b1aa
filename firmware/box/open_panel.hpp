#pragma once

#include <memory>
#include <string>

#include "loop/file_descriptor.hpp"
#include "panel/lines.hpp"
#include "settings/board.hpp"

namespace adit::box {

/// What the board's file says.
struct KnownBoard {
  settings::Board board;  // empty where there is none
  std::string trouble;    // why it does not count; or ""
};
/// `file` may be "", and need not be there.
KnownBoard read_board(const std::string& file);

struct OpenPanel {
  std::unique_ptr<panel::Lines> lines;
  std::unique_ptr<panel::ButtonLine> button;  // null: there is none
};
/// Where the panel is, other than at the lines of the settings.
struct PanelPlace {
  std::string socket;  // of adit-panel, which holds the lines; "": nobody does
  std::string folder;  // of a simulated panel
};
/// The panel that adit-panel holds. Where nobody does, its lines, or a simulated panel in the folder: the
/// file `panel`, and where no line is named at all the FIFO `panel.button`. What cannot be had is logged.
/// `announced`: panel::announce(), or empty.
OpenPanel open_panel(const settings::Panel& settings, const PanelPlace& place,
                     loop::FileDescriptor announced = {});

}  // namespace adit::box
