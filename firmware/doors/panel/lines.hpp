#pragma once

#include <expected>
#include <memory>
#include <string>

#include "panel/panel.hpp"
#include "settings/settings.hpp"

namespace adit::panel {

/// "panel: ABOUT: REASON". `error` is an errno.
std::unexpected<std::string> panel_error(const std::string& about, int error);

/// The lines of the lights. Tests and the simulated panel replace GPIO here.
class Lines {
 public:
  virtual ~Lines() = default;
  /// Sets all lights. An error says why some lights may be wrong; Adit continues: painter.hpp.
  virtual std::expected<void, std::string> set(const Lit& lit) = 0;
  /// True if a well program must set the lights at least once a second, so that the lines' holder knows.
  virtual bool is_watched() const { return false; }
};

class ButtonLine {
 public:
  virtual ~ButtonLine() = default;
  /// Readable after the button was pressed or released. Owned by this object.
  virtual int descriptor() const = 0;
  /// The present level. Consumes what made descriptor() readable. An error means that the line cannot be
  /// read; the caller must cancel a press. It may call again later.
  virtual std::expected<bool, std::string> is_pressed() = 0;
};

/// Opens the lines named in `settings` with libgpiod, for `consumer` (shown by gpioinfo(1) as their user).
/// The chip is found by name, label or path; if no chip is named, the line's name is looked up on all chips.
/// Unnamed lines are skipped. All lights are dark at first and when closed. Lines stay lost after their chip
/// vanishes: held.hpp.
std::expected<std::unique_ptr<Lines>, std::string> open_gpio(const settings::Panel& settings,
                                                             const std::string& consumer);
/// Opens the line of the button, which must be named. If the chip supports it, the line is pulled to "not
/// pressed", so that an unconnected line is no pressed button.
std::expected<std::unique_ptr<ButtonLine>, std::string> open_gpio_button(const settings::Panel& settings,
                                                                         const std::string& consumer);
/// libgpiod's version.
std::string gpiod_version();

/// A panel without GPIO. Its state is in `file` ("health on\n..."), replaced atomically at each change.
std::unique_ptr<Lines> make_simulated_lines(std::string file);
/// The simulated button: a new FIFO for this user only. It accepts the lines "press" and "release" and
/// ignores others. Replaces a file at `fifo`.
std::expected<std::unique_ptr<ButtonLine>, std::string> simulated_button(const std::string& fifo);

}  // namespace adit::panel
