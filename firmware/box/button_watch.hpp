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

/// Watches the button on the loop, and shows while it is held what letting go would do. Where it cannot be
/// read, what was pressed comes to nothing, and it is looked at again: as at the start, a button that is
/// pressed then is none until it was let go.
class ButtonWatch {
 public:
  /// `line` may be null: there is no button. `lights` outlives this. A press that has ended is told by
  /// `pressed`, which may not destroy this.
  ButtonWatch(loop::Loop& loop, std::unique_ptr<panel::ButtonLine> line, Lights& lights,
              std::function<void(panel::Press)> pressed);

  /// Lets go of the line: another, which may be the same, is taken next.
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
  std::optional<panel::Button> button_;  // nothing: there is none, or it cannot be read
  bool is_lost_ = false;                 // which was logged
  loop::Source edges_, due_;             // after line_: ended before its descriptor is closed
};

}  // namespace adit::box
