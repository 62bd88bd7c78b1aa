#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace adit::panel {

using Instant = std::chrono::steady_clock::time_point;

/// What somebody asked for with the button.
enum class Press : std::uint8_t { Identify, ShowAddress, Reset };

/// The button's one table of times, and what is made of them. It knows no clock: each call says what time it
/// is, and times never run backward.
///
/// held for        when let go             while held
/// up to 3 s       Identify                nothing shows
/// 3 to 6 s        ShowAddress             Phase::Held
/// 6 to 10 s       nothing at all          Phase::Warning
/// 10 s            (it is over already)    Reset, at once; then nothing until it is let go
///
/// Whoever lets go because of the warning wants out, so nothing else comes of it either. A button that is
/// pressed from the beginning is stuck, or still held since a reset: nothing comes of it until it was let go.
class Button {
 public:
  static constexpr std::chrono::milliseconds kBounce{30};  // so long a level has to last to count
  static constexpr std::chrono::seconds kHold{3}, kWarn{6}, kReset{10};

  enum class Phase : std::uint8_t { Idle, Pressed, Held, Warning, Ignored };

  Button(bool pressed, Instant now)
      : level_(pressed), since_(now), phase_(pressed ? Phase::Ignored : Phase::Idle) {}

  /// What the line says now, whenever it may have changed. A release that is seen late is never a reset.
  std::optional<Press> level(bool pressed, Instant now);
  /// What has come by time alone. Call it after level(), and at next().
  std::optional<Press> advance(Instant now);

  Phase phase() const { return phase_; }
  /// When advance() is due; nothing: not before the level changes.
  std::optional<Instant> next() const;

 private:
  bool is_down() const { return phase_ != Phase::Idle; }
  bool bounces() const { return level_ != is_down(); }
  std::optional<Press> settle(Instant now);
  Phase phase_after(Instant now) const;

  bool level_;     // as the line says
  Instant since_;  // when it began to say so
  Phase phase_;
  Instant pressed_{};  // when the press began that the phase is of
};

}  // namespace adit::panel
