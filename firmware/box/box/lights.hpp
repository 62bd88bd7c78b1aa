#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "panel/button.hpp"
#include "panel/lines.hpp"
#include "panel/painter.hpp"
#include "panel/reopened.hpp"
#include "panel/states.hpp"
#include "settings/settings.hpp"

namespace adit::box {

/// The panel's place, if not the lines in the settings.
struct PanelPlace {
  std::string socket;  // adit-panel's socket; "": not used
  std::string folder;  // of a simulated panel
};
/// adit-panel's panel, or one that this process holds. The simulated panel is the file `panel` in the folder.
/// `announced`: panel::announce(), or empty.
panel::PanelDevices open_panel(const settings::Panel& settings, const PanelPlace& place,
                               loop::FileDescriptor announced = {});

/// Shows states on the panel. The loop times patterns and repetitions (panel::Painter).
class Lights {
 public:
  Lights(loop::Loop& loop, std::unique_ptr<panel::Lines> lines);

  /// Releases the lines, before set_lines() with others or the same.
  void release_lines() { painter_.set_lines(nullptr); }
  void set_lines(std::unique_ptr<panel::Lines> lines);

  /// Call once a second: sets watched lines again, which shows their holder that the loop turns.
  void send_heartbeat();

  void set(panel::LightState state, bool asserted);
  /// For `length` from now on.
  void set_for(panel::LightState state, loop::Duration length);
  /// Asserts panel::LightState::Address while the steps play once.
  void play_digits(std::vector<panel::Step> steps);
  bool has(panel::LightState state) const { return states_.has(state); }
  /// Remaining time of set_for(), or nullopt.
  std::optional<loop::Duration> remaining(panel::LightState state) const;
  const panel::Lights& shown_lights() const { return shown_; }
  /// Why the panel may differ, or "".
  const std::string& trouble() const { return painter_.trouble(); }

 private:
  using Milliseconds = panel::Milliseconds;
  Milliseconds elapsed_time(loop::Instant then) const;
  std::optional<loop::Instant>& deadline(panel::LightState state) {
    return until_[static_cast<std::size_t>(state)];
  }
  void clear_expired();
  panel::Frame frame() const;
  void paint();
  void log_trouble();
  void schedule_next_frame(const panel::Frame& frame);

  loop::Loop& loop_;
  panel::Painter painter_;
  loop::Instant began_, digits_began_;
  loop::Source tick_;
  panel::States states_;
  std::array<std::optional<loop::Instant>, panel::kStates> until_;  // ends of timed states
  std::vector<panel::Step> digits_;
  panel::Lights shown_{};
};

/// Watches the button on the loop, and shows the effect of a release while it is held. If the line cannot be
/// read, cancels the press and retries. A button pressed then, or at the start, counts from its next press.
class ButtonWatch {
 public:
  /// Null `line`: no button. `lights` outlives this. `pressed` (a press ended) must not destroy this.
  ButtonWatch(loop::Loop& loop, std::unique_ptr<panel::ButtonLine> line, Lights& lights,
              std::function<void(panel::Press)> pressed);

  /// Releases the line, before set_line() with another or the same.
  void release_line();
  void set_line(std::unique_ptr<panel::ButtonLine> line);

 private:
  void poll();
  void begin(bool pressed);
  void on_lost(const std::string& why);
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
