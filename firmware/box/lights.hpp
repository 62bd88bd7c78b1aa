#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loop/loop.hpp"
#include "panel/lines.hpp"
#include "panel/painter.hpp"
#include "panel/states.hpp"

namespace adit::box {

/// Shows states on the panel: patterns, and what is set again (panel::Painter), are timed by the loop.
class Lights {
 public:
  Lights(loop::Loop& loop, std::unique_ptr<panel::Lines> lines);

  /// Lets go of the lines: others, which may be the same, are taken next.
  void let_go();
  void take(std::unique_ptr<panel::Lines> lines);

  /// Call once a second: sets watched lines again, which shows their holder that the loop turns.
  void beat();

  /// Asserts or clears a state.
  void set(panel::State state, bool asserted);
  /// Asserts it for so long from now on.
  void set_for(panel::State state, loop::Duration length);
  /// Asserts panel::State::Address while these steps are played, once.
  void play_digits(std::vector<panel::Step> steps);
  bool has(panel::State state) const { return states_.has(state); }
  /// For how much longer set_for() asserts it; nothing: it does not.
  std::optional<loop::Duration> left(panel::State state) const;
  const panel::Lights& shown() const { return shown_; }
  /// Why the panel may show something else; or "".
  const std::string& trouble() const { return painter_.trouble(); }

 private:
  using Milliseconds = panel::Milliseconds;
  Milliseconds since(loop::Instant then) const;
  std::optional<loop::Instant>& until(panel::State state) { return until_[static_cast<std::size_t>(state)]; }
  void clear_what_is_over();
  panel::Frame frame() const;
  void paint();
  void log_trouble();
  void wake_for_what_is_next(const panel::Frame& frame);

  loop::Loop& loop_;
  panel::Painter painter_;
  loop::Instant began_, digits_began_;
  loop::Source tick_;
  panel::States states_;
  std::array<std::optional<loop::Instant>, panel::kStates> until_;  // of those that end by themselves
  std::vector<panel::Step> digits_;
  panel::Lights shown_{};
};

}  // namespace adit::box
