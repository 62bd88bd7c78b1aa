#pragma once

#include <functional>
#include <memory>
#include <string>

#include "panel/lines.hpp"

namespace adit::panel {

/// The lights and the button of a panel.
struct Held {
  std::unique_ptr<Lines> lines;        // null: there are none
  std::unique_ptr<ButtonLine> button;  // null: there is none
};

/// Opens the panel of `settings` for `consumer` (shown by gpioinfo(1) as its user). Lines that are lost or
/// not available yet are opened again; until then set() and pressed() fail. `complain` gets an error of the
/// button. `simulated` is the file of a simulated panel; "": there is none. Its lights stand in for lines
/// that cannot be opened. Its button, `simulated`.button, is used only if `settings` names no line at all.
Held hold(const settings::Panel& settings, const std::string& consumer, const std::string& simulated,
          const std::function<void(const std::string&)>& complain);

}  // namespace adit::panel
