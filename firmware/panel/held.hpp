#pragma once

#include <functional>
#include <memory>
#include <string>

#include "panel/lines.hpp"

namespace adit::panel {

/// What somebody holds of a panel.
struct Held {
  std::unique_ptr<Lines> lines;        // null: there are none
  std::unique_ptr<ButtonLine> button;  // null: there is none
};

/// The panel of the settings, for `consumer` (what gpioinfo(1) shows as its user). What is lost, or cannot be
/// had yet, is opened again; that it is not there is the error of each set() and pressed(). `simulated` is
/// the file of a simulated panel, whose lights stand in for lines that cannot be had, and whose button is
/// `simulated`.button where no line is named at all; "": there is none.
Held hold(const settings::Panel& settings, const std::string& consumer, const std::string& simulated,
          const std::function<void(const std::string&)>& complain);

}  // namespace adit::panel
