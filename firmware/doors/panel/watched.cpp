#include "panel/watched.hpp"

#include "panel/states.hpp"

namespace adit::panel {
namespace {

Milliseconds between(Instant from, Instant to) {
  return std::chrono::duration_cast<Milliseconds>(to - from);
}

const Lights& fault_lights() {
  static const Lights lights = [] {
    States states;
    states.set(State::Fault, true);
    return states.shown();
  }();
  return lights;
}

}  // namespace

void Watched::enter(Phase phase, Instant now) {
  phase_ = phase;
  since_ = now;
}

/// After a death the fault shows until the next aditd sends lights.
void Watched::came(Instant now) {
  if (phase_ == Phase::Awaited || phase_ == Phase::Ended) enter(Phase::Awaited, now);
}

void Watched::lights(const Lit& lit, Instant now) {
  enter(Phase::Well, now);
  lit_ = lit;
}

void Watched::ends(Instant now) {
  enter(Phase::Ended, now);
}

void Watched::gone(Instant now) {
  if (phase_ == Phase::Ended || phase_ == Phase::Dead) return;
  enter(Phase::Dead, fault_since(now).value_or(now));
}

std::optional<Instant> Watched::fault_since(Instant now) const {
  const auto since = [&](Instant then) { return now >= then ? std::optional(then) : std::nullopt; };
  switch (phase_) {
    case Phase::Awaited:
      return since(since_ + kStart);
    case Phase::Well:
      return since(since_ + kSilence);
    case Phase::Dead:
      return since_;
    case Phase::Ended:
      break;
  }
  return std::nullopt;
}

Frame Watched::frame(Instant now) const {
  if (const auto fault = fault_since(now)) return frame_of(fault_lights(), between(*fault, now));
  switch (phase_) {
    case Phase::Awaited:
      return {{}, between(now, since_ + kStart)};
    case Phase::Well:
      return {lit_, between(now, since_ + kSilence)};
    case Phase::Ended:
    case Phase::Dead:
      break;
  }
  return {};
}

}  // namespace adit::panel
