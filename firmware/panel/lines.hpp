#pragma once

#include <expected>
#include <memory>
#include <string>

#include "panel/panel.hpp"
#include "settings/settings.hpp"

namespace adit::panel {

/// The lines that lights hang on: the seam between the panel and GPIO.
class Lines {
 public:
  virtual ~Lines() = default;
  /// Sets all lights. An error says why some may not show it, and the rest of Adit goes on: painter.hpp.
  virtual std::expected<void, std::string> set(const Lit& lit) = 0;
  /// Whether they are set over and over (Watched::kBeat) while the program is well, so that whoever holds the
  /// lines knows.
  virtual bool is_watched() const { return false; }
};

/// The line of the button.
class ButtonLine {
 public:
  virtual ~ButtonLine() = default;
  /// Is readable once the button was pressed or let go. It stays this one's.
  virtual int descriptor() const = 0;
  /// Whether it is pressed by now; what made descriptor() readable is read. An error: it cannot be read, and
  /// a press that was under way comes to nothing. It may be asked again later.
  virtual std::expected<bool, std::string> pressed() = 0;
};

/// The lines named in the settings, by libgpiod, for `consumer` (what gpioinfo(1) shows as their user): on
/// the chip of that name, label or path, or with no chip named, on whichever has a line of that name. Lines
/// without a name are left out. All are dark at first, and dark when they are let go at the end. Lines whose
/// chip vanishes stay lost, and so does the button's: reopened.hpp.
std::expected<std::unique_ptr<Lines>, std::string> open_gpio(const settings::Panel& settings,
                                                             const std::string& consumer);
/// The button's, which has to be named. Where the chip can, it is pulled to where it is not pressed, so that
/// a line that nothing hangs on is no button that is held.
std::expected<std::unique_ptr<ButtonLine>, std::string> open_gpio_button(const settings::Panel& settings,
                                                                         const std::string& consumer);
/// libgpiod's own version.
std::string gpiod_version();

/// A panel without GPIO: what it shows is readable from `file` ("health on\n..."), rewritten atomically at
/// each change.
std::unique_ptr<Lines> simulated(std::string file);
/// Its button: a FIFO, made new for this user alone, that takes the lines "press" and "release"; whatever
/// else comes is ignored.
std::expected<std::unique_ptr<ButtonLine>, std::string> simulated_button(const std::string& fifo);

}  // namespace adit::panel
