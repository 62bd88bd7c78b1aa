#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace adit::panel {

using Instant = std::chrono::steady_clock::time_point;

/// An operator's request by the button.
enum class Press : std::uint8_t { Identify, ShowAddress, Reset };

/// Measures how long the button is held, and decides what that means. It reads no clock: each call gets the
/// time, which never runs backward.
///
/// held for        if released              while held
/// up to 3 s       Identify                 Phase::Pressed
/// 3 to 6 s        ShowAddress              Phase::Held
/// 6 to 10 s       no effect                Phase::Warning
/// 10 s            no effect                Reset, at once; then no effect until it is released
///
/// A release during the warning has no effect, because the person wants to cancel. A button that is pressed
/// at the start is stuck, or held since a reset. It has no effect until it is released.
class Button {
 public:
  static constexpr std::chrono::milliseconds kBounce{30};  // a level must last this long to count
  static constexpr std::chrono::seconds kHold{3}, kWarn{6}, kReset{10};

  enum class Phase : std::uint8_t { Idle, Pressed, Held, Warning, Ignored };

  Button(bool pressed, Instant now)
      : level_(pressed), since_(now), phase_(pressed ? Phase::Ignored : Phase::Idle) {}

  /// Call this with the line's level whenever it may have changed. A release seen late is never a reset.
  std::optional<Press> level(bool pressed, Instant now);
  /// Call this after level(), and at next(). Handles the passing of time.
  std::optional<Press> advance(Instant now);

  Phase phase() const { return phase_; }
  /// When advance() is due; nullopt: not before the level changes.
  std::optional<Instant> next() const;

 private:
  bool is_down() const { return phase_ != Phase::Idle; }
  bool bounces() const { return level_ != is_down(); }
  std::optional<Press> settle(Instant now);
  Phase phase_after(Instant now) const;

  bool level_;     // the line's level
  Instant since_;  // the start of that level
  Phase phase_;
  Instant pressed_{};  // the start of the press
};

}  // namespace adit::panel
