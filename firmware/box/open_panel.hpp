#pragma once

#include <memory>
#include <string>

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
/// The panel's lines, or a simulated panel in `folder`: the file `panel`, and where no line is named at all
/// the FIFO `panel.button`. What cannot be had is logged.
OpenPanel open_panel(const settings::Panel& settings, const std::string& folder);

}  // namespace adit::box
