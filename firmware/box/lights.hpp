#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "loop/loop.hpp"
#include "panel/lines.hpp"
#include "panel/states.hpp"

namespace adit::box {

/// Shows states on the panel: patterns are timed by the loop, which is woken only while something blinks, or
/// while somebody watches the lines for whether it turns.
class Lights {
 public:
  Lights(loop::Loop& loop, std::unique_ptr<panel::Lines> lines);

  /// Lets go of the lines: others, which may be the same, are taken next.
  void let_go();
  void take(std::unique_ptr<panel::Lines> lines);

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

 private:
  using Milliseconds = panel::Milliseconds;
  Milliseconds since(loop::Instant then) const;
  std::optional<loop::Instant>& until(panel::State state) { return until_[static_cast<std::size_t>(state)]; }
  void clear_what_is_over();
  panel::Frame frame() const;
  void paint();
  void light_up(const panel::Lit& lit);
  bool is_watched() const;
  void beat();
  void wake_for_what_is_next(const panel::Frame& frame);

  loop::Loop& loop_;
  std::unique_ptr<panel::Lines> lines_;
  loop::Instant began_, digits_began_;
  loop::Source tick_, beat_;
  panel::States states_;
  std::array<std::optional<loop::Instant>, panel::kStates> until_;  // of those that end by themselves
  std::vector<panel::Step> digits_;
  panel::Lights shown_{};
  std::optional<panel::Lit> lit_;
  bool broken_ = false;
};

}  // namespace adit::box
