#include "box/button_watch.hpp"

#include <sys/epoll.h>

#include <chrono>
#include <utility>

#include "host/log.hpp"

namespace adit::box {
namespace {

using panel::Button;

constexpr std::chrono::seconds kAgain{2};  // to the next try after a failed read

}  // namespace

ButtonWatch::ButtonWatch(loop::Loop& loop, std::unique_ptr<panel::ButtonLine> line, Lights& lights,
                         std::function<void(panel::Press)> pressed)
    : loop_(loop), lights_(lights), pressed_(std::move(pressed)) {
  take(std::move(line));
}

void ButtonWatch::let_go() {
  edges_ = {};
  due_ = {};
  line_.reset();
  button_.reset();
  show();
}

void ButtonWatch::take(std::unique_ptr<panel::ButtonLine> line) {
  line_ = std::move(line);
  if (!line_) return;
  edges_ = loop_.watch(line_->descriptor(), EPOLLIN, [this](std::uint32_t) { look(); });
  due_ = loop_.timer([this] { look(); });
  look();
}

/// Reads the line at each timer event, because its last change may not have been reported yet.
void ButtonWatch::look() {
  const auto level = line_->pressed();
  if (!level) return lose(level.error());
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
void ButtonWatch::lose(const std::string& why) {
  due_.call_at(loop_.now() + kAgain);
  if (std::exchange(button_, std::nullopt)) show();
  if (!std::exchange(is_lost_, true)) {
    host::log(host::Level::Error, "cannot read the button: retrying", {{"why", why}});
  }
}

void ButtonWatch::show() {
  lights_.set(panel::State::ButtonHeld, button_ && button_->phase() == Button::Phase::Held);
  lights_.set(panel::State::ResetWarning, button_ && button_->phase() == Button::Phase::Warning);
}

}  // namespace adit::box
