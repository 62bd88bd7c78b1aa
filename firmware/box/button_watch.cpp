#include "box/button_watch.hpp"

#include <sys/epoll.h>

#include <utility>

#include "host/log.hpp"

namespace adit::box {

using panel::Button;

ButtonWatch::ButtonWatch(loop::Loop& loop, std::unique_ptr<panel::ButtonLine> line, Lights& lights,
                         std::function<void(panel::Press)> pressed)
    : loop_(loop), lights_(lights), pressed_(std::move(pressed)) {
  take(std::move(line));
}

void ButtonWatch::let_go() {
  edges_ = {};
  due_ = {};
  line_.reset();
  button_ = Button(false, loop_.now());
  show();
}

void ButtonWatch::take(std::unique_ptr<panel::ButtonLine> line) {
  line_ = std::move(line);
  if (!line_) return;
  const auto first = line_->pressed();
  if (!first) {
    give_up(first.error());
    return;
  }
  button_ = Button(*first, loop_.now());
  if (*first) {
    host::log(host::Level::Warning, "the button is held since before the start: let it go before it is used");
  }
  edges_ = loop_.watch(line_->descriptor(), EPOLLIN, [this](std::uint32_t) { look(); });
  due_ = loop_.timer([this] { look(); });
}

/// The line is looked at also when time alone calls: what it says by now may not have been told yet.
void ButtonWatch::look() {
  const auto level = line_->pressed();
  if (!level) return give_up(level.error());
  const loop::Instant now = loop_.now();
  const auto before = button_.level(*level, now);
  const auto after = button_.advance(now);
  if (const auto next = button_.next()) {
    due_.call_at(*next);
  } else {
    due_.cancel();
  }
  show();
  if (before) pressed_(*before);
  if (after) pressed_(*after);
}

void ButtonWatch::show() {
  lights_.set(panel::State::ButtonHeld, button_.phase() == Button::Phase::Held);
  lights_.set(panel::State::ResetWarning, button_.phase() == Button::Phase::Warning);
}

/// Without it the page does all that the button does, but for the forgotten password.
void ButtonWatch::give_up(const std::string& why) {
  host::log(host::Level::Error, "the button cannot be read, and is left alone from now on", {{"why", why}});
  edges_ = {};
  due_ = {};
  button_ = Button(false, loop_.now());
  show();
}

}  // namespace adit::box
