#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "box/lights.hpp"
#include "loop/loop.hpp"
#include "panel/button.hpp"
#include "panel/lines.hpp"

namespace adit::box {

/// Watches the button on the loop and shows the effect of a release while it is held. If the line cannot be
/// read, the press is cancelled and the line is tried again. A button that is pressed then, or at the start,
/// counts from its next press.
class ButtonWatch {
 public:
  /// A null `line`: no button. `lights` outlives this. `pressed` is called when a press ends, and must not
  /// destroy this.
  ButtonWatch(loop::Loop& loop, std::unique_ptr<panel::ButtonLine> line, Lights& lights,
              std::function<void(panel::Press)> pressed);

  /// Releases the line, before take() with another or the same.
  void let_go();
  void take(std::unique_ptr<panel::ButtonLine> line);

 private:
  void look();
  void begin(bool pressed);
  void lose(const std::string& why);
  void show();

  loop::Loop& loop_;
  std::unique_ptr<panel::ButtonLine> line_;
  Lights& lights_;
  std::function<void(panel::Press)> pressed_;
  std::optional<panel::Button> button_;  // nullopt: no button, or not readable
  bool is_lost_ = false;                 // and logged
  loop::Source edges_, due_;             // after line_: ended before its descriptor is closed
};

}  // namespace adit::box
