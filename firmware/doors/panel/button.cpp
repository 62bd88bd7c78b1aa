#include "panel/button.hpp"

#include <utility>

namespace adit::panel {

std::optional<Press> Button::level(bool pressed, Instant now) {
  const auto came = settle(now);
  if (pressed != level_) {
    level_ = pressed;
    since_ = now;
  }
  return came;
}

std::optional<Press> Button::advance(Instant now) {
  if (const auto came = settle(now)) return came;
  const bool may_be_let_go = bounces();
  if (may_be_let_go || phase_ == Phase::Idle || phase_ == Phase::Ignored) return std::nullopt;
  phase_ = phase_after(now);
  return phase_ == Phase::Ignored ? std::optional(Press::Reset) : std::nullopt;
}

/// A level that has lasted long enough counts from its start.
std::optional<Press> Button::settle(Instant now) {
  if (!bounces() || now - since_ < kBounce) return std::nullopt;
  if (level_) {
    phase_ = Phase::Pressed;
    pressed_ = since_;
    return std::nullopt;
  }
  const Phase before = std::exchange(phase_, Phase::Idle);
  if (before == Phase::Ignored) return std::nullopt;
  const auto held = since_ - pressed_;
  if (held < kHold) return Press::Identify;
  if (held < kWarn) return Press::ShowAddress;
  return std::nullopt;
}

Button::Phase Button::phase_after(Instant now) const {
  const auto held = now - pressed_;
  if (held >= kReset) return Phase::Ignored;
  if (held >= kWarn) return Phase::Warning;
  return held >= kHold ? Phase::Held : Phase::Pressed;
}

std::optional<Instant> Button::next() const {
  if (bounces()) return since_ + kBounce;
  switch (phase_) {
    case Phase::Pressed:
      return pressed_ + kHold;
    case Phase::Held:
      return pressed_ + kWarn;
    case Phase::Warning:
      return pressed_ + kReset;
    case Phase::Idle:
    case Phase::Ignored:
      break;
  }
  return std::nullopt;
}

}  // namespace adit::panel
