#include "box/lights.hpp"

#include <algorithm>
#include <utility>

#include "host/log.hpp"

namespace adit::box {

Lights::Lights(loop::Loop& loop, std::unique_ptr<panel::Lines> lines)
    : loop_(loop), began_(loop.now()), digits_began_(began_), tick_(loop.timer([this] { paint(); })) {
  painter_.take(std::move(lines));
}

void Lights::let_go() {
  painter_.take(nullptr);
}

void Lights::beat() {
  if (painter_.lines() == nullptr || !painter_.lines()->is_watched()) return;
  painter_.set(frame().lit, loop_.now());
  paint();
}

void Lights::take(std::unique_ptr<panel::Lines> lines) {
  painter_.take(std::move(lines));
  paint();
}

void Lights::set(panel::State state, bool asserted) {
  until(state).reset();
  if (states_.set(state, asserted) || painter_.is_blank()) paint();
}

void Lights::set_for(panel::State state, loop::Duration length) {
  until(state) = loop_.now() + length;
  states_.set(state, true);
  paint();
}

void Lights::play_digits(std::vector<panel::Step> steps) {
  digits_ = std::move(steps);
  digits_began_ = loop_.now();
  set_for(panel::State::Address, panel::length_of(digits_));
}

std::optional<loop::Duration> Lights::left(panel::State state) const {
  const auto& until = until_[static_cast<std::size_t>(state)];
  const loop::Instant now = loop_.now();
  return until && now < *until ? std::optional(*until - now) : std::nullopt;
}

void Lights::clear_what_is_over() {
  const loop::Instant now = loop_.now();
  for (const panel::StateRow& row : panel::state_table()) {
    auto& end = until(row.state);
    if (!end || now < *end) continue;
    end.reset();
    states_.set(row.state, false);
  }
}

Lights::Milliseconds Lights::since(loop::Instant then) const {
  return std::chrono::duration_cast<Milliseconds>(loop_.now() - then);
}

panel::Frame Lights::frame() const {
  panel::Frame frame = panel::frame_of(shown_, since(began_));
  for (const panel::Light light : panel::kLights) {
    if (shown_[panel::index_of(light)] != panel::Pattern::Digits) continue;
    const panel::Moment moment = panel::once(digits_, since(digits_began_));
    frame.lit[panel::index_of(light)] = moment.lit;
    if (moment.lasts) frame.lasts = std::min(*moment.lasts, frame.lasts.value_or(*moment.lasts));
  }
  return frame;
}

void Lights::paint() {
  clear_what_is_over();
  shown_ = states_.shown();
  const panel::Frame now = frame();
  painter_.show(now.lit, loop_.now());
  log_trouble();
  wake_for_what_is_next(now);
}

void Lights::log_trouble() {
  if (!painter_.has_turned()) return;
  if (trouble().empty()) {
    host::log(host::Level::Notice, "panel lights work again");
  } else {
    host::log(host::Level::Error, "cannot set the panel lights", {{"why", trouble()}});
  }
}

void Lights::wake_for_what_is_next(const panel::Frame& frame) {
  std::optional<loop::Instant> next = painter_.next();
  const auto no_later_than = [&next](loop::Instant when) { next = std::min(when, next.value_or(when)); };
  // One more millisecond, because durations are rounded down.
  if (frame.lasts) no_later_than(loop_.now() + *frame.lasts + Milliseconds(1));
  for (const auto& end : until_) {
    if (end) no_later_than(*end);
  }
  tick_.cancel();
  if (next) tick_.call_at(*next);
}

}  // namespace adit::box
