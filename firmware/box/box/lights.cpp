#include "box/lights.hpp"

#include <sys/epoll.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "host/log.hpp"
#include "panel/reopened.hpp"

namespace adit::box {

panel::PanelDevices open_panel(const settings::Panel& settings, const PanelPlace& place,
                               loop::FileDescriptor announced) {
  if (!place.socket.empty()) {
    auto held = panel::remote(place.socket, settings, std::move(announced));
    if (held) return std::move(*held);
    host::log(host::Level::Error, "cannot use adit-panel: the panel is simulated", {{"why", held.error()}});
  }
  return panel::hold(settings, "aditd", place.folder + "/panel",
                     [](const std::string& sentence) { host::log(host::Level::Error, sentence); });
}

Lights::Lights(loop::Loop& loop, std::unique_ptr<panel::Lines> lines)
    : loop_(loop), began_(loop.now()), digits_began_(began_), tick_(loop.timer([this] { paint(); })) {
  painter_.set_lines(std::move(lines));
}

void Lights::send_heartbeat() {
  if (painter_.lines() == nullptr || !painter_.lines()->is_watched()) return;
  painter_.set(frame().lit, loop_.now());
  paint();
}

void Lights::set_lines(std::unique_ptr<panel::Lines> lines) {
  painter_.set_lines(std::move(lines));
  paint();
}

void Lights::set(panel::LightState state, bool asserted) {
  deadline(state).reset();
  if (states_.set(state, asserted) || painter_.is_blank()) paint();
}

void Lights::set_for(panel::LightState state, loop::Duration length) {
  deadline(state) = loop_.now() + length;
  states_.set(state, true);
  paint();
}

void Lights::play_digits(std::vector<panel::Step> steps) {
  digits_ = std::move(steps);
  digits_began_ = loop_.now();
  set_for(panel::LightState::Address, panel::length_of(digits_));
}

std::optional<loop::Duration> Lights::remaining(panel::LightState state) const {
  const auto& until = until_[static_cast<std::size_t>(state)];
  const loop::Instant now = loop_.now();
  return until && now < *until ? std::optional(*until - now) : std::nullopt;
}

void Lights::clear_expired() {
  const loop::Instant now = loop_.now();
  for (const panel::StateRow& row : panel::state_table()) {
    auto& end = deadline(row.state);
    if (!end || now < *end) continue;
    end.reset();
    states_.set(row.state, false);
  }
}

Lights::Milliseconds Lights::elapsed_time(loop::Instant then) const {
  return std::chrono::duration_cast<Milliseconds>(loop_.now() - then);
}

panel::Frame Lights::frame() const {
  panel::Frame frame = panel::frame_of(shown_, elapsed_time(began_));
  for (const panel::Light light : panel::kLights) {
    if (shown_[panel::index_of(light)] != panel::Pattern::Digits) continue;
    const panel::Moment moment = panel::single_moment(digits_, elapsed_time(digits_began_));
    frame.lit[panel::index_of(light)] = moment.lit;
    if (moment.lasts) frame.lasts = std::min(*moment.lasts, frame.lasts.value_or(*moment.lasts));
  }
  return frame;
}

void Lights::paint() {
  clear_expired();
  shown_ = states_.current_lights();
  const panel::Frame now = frame();
  painter_.show(now.lit, loop_.now());
  log_trouble();
  schedule_next_frame(now);
}

void Lights::log_trouble() {
  if (!painter_.has_turned()) return;
  if (trouble().empty()) {
    host::log(host::Level::Notice, "panel lights work again");
  } else {
    host::log(host::Level::Error, "cannot set the panel lights", {{"why", trouble()}});
  }
}

void Lights::schedule_next_frame(const panel::Frame& frame) {
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

namespace {

using panel::Button;

constexpr std::chrono::seconds kAgain{2};  // to the next try after a failed read

}  // namespace

ButtonWatch::ButtonWatch(loop::Loop& loop, std::unique_ptr<panel::ButtonLine> line, Lights& lights,
                         std::function<void(panel::Press)> pressed)
    : loop_(loop), lights_(lights), pressed_(std::move(pressed)) {
  set_line(std::move(line));
}

void ButtonWatch::release_line() {
  edges_ = {};
  due_ = {};
  line_.reset();
  button_.reset();
  show();
}

void ButtonWatch::set_line(std::unique_ptr<panel::ButtonLine> line) {
  line_ = std::move(line);
  if (!line_) return;
  edges_ = loop_.watch(line_->descriptor(), EPOLLIN, [this](std::uint32_t) { poll(); });
  due_ = loop_.timer([this] { poll(); });
  poll();
}

/// Reads the line at each timer event, because its last change may not have been reported yet.
void ButtonWatch::poll() {
  const auto level = line_->is_pressed();
  if (!level) return on_lost(level.error());
  if (!button_) return begin(*level);
  const loop::Instant now = loop_.now();
  const auto before = button_->level(*level, now);
  const auto after = button_->advance(now);
  due_.cancel();
  if (const auto next = button_->next()) due_.call_at(*next);
  show();
  if (before) pressed_(*before);
  if (after) pressed_(*after);
}

void ButtonWatch::begin(bool pressed) {
  button_.emplace(pressed, loop_.now());
  if (std::exchange(is_lost_, false)) host::log(host::Level::Notice, "button works again");
  if (pressed) host::log(host::Level::Warning, "button is pressed at the start: release it before use");
}

/// The page can replace the button, except for a forgotten password.
void ButtonWatch::on_lost(const std::string& why) {
  due_.call_at(loop_.now() + kAgain);
  if (std::exchange(button_, std::nullopt)) show();
  if (!std::exchange(is_lost_, true)) {
    host::log(host::Level::Error, "cannot read the button: retrying", {{"why", why}});
  }
}

void ButtonWatch::show() {
  lights_.set(panel::LightState::ButtonHeld, button_ && button_->phase() == Button::Phase::Held);
  lights_.set(panel::LightState::ResetWarning, button_ && button_->phase() == Button::Phase::Warning);
}

}  // namespace adit::box
