#include "panel/keeper.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "panel/messages.hpp"
#include "panel/states.hpp"

namespace adit::panel {
namespace {

Milliseconds milliseconds_between(Instant from, Instant to) {
  return std::chrono::duration_cast<Milliseconds>(to - from);
}

const Lights& fault_lights() {
  static const Lights lights = [] {
    States states;
    states.set(LightState::Fault, true);
    return states.current_lights();
  }();
  return lights;
}

}  // namespace

void HeartbeatMonitor::enter(Phase phase, Instant now) {
  phase_ = phase;
  since_ = now;
}

/// After a death the fault shows until the next aditd sends lights.
void HeartbeatMonitor::on_contact(Instant now) {
  if (phase_ == Phase::Awaited || phase_ == Phase::Ended) enter(Phase::Awaited, now);
}

void HeartbeatMonitor::on_lights(const Lit& lit, Instant now) {
  enter(Phase::Well, now);
  lit_ = lit;
}

void HeartbeatMonitor::on_gone(Instant now) {
  if (phase_ == Phase::Ended || phase_ == Phase::Dead) return;
  enter(Phase::Dead, fault_start(now).value_or(now));
}

std::optional<Instant> HeartbeatMonitor::fault_start(Instant now) const {
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

Frame HeartbeatMonitor::frame(Instant now) const {
  if (const auto fault = fault_start(now)) return frame_of(fault_lights(), milliseconds_between(*fault, now));
  switch (phase_) {
    case Phase::Awaited:
      return {{}, milliseconds_between(now, since_ + kStart)};
    case Phase::Well:
      return {lit_, milliseconds_between(now, since_ + kSilence)};
    case Phase::Ended:
    case Phase::Dead:
      break;
  }
  return {};
}

namespace {

constexpr int kHeardAtOnce = 64;  // messages at once, so that a flood of messages cannot delay the lights

}  // namespace

Keeper::Keeper(loop::Loop& loop, loop::FileDescriptor listening, std::optional<settings::Panel> boards,
               Callbacks world)
    : loop_(loop),
      world_(std::move(world)),
      watched_(loop.now()),
      knows_board_(boards.has_value()),
      listening_(std::move(listening)),
      tick_(loop.timer([this] { show(); })),
      callers_(loop.watch(listening_.get(), EPOLLIN, [this](std::uint32_t) { accept(); })) {
  if (boards) configure(*boards);
  show();
}

/// A previous connection is closed: its aditd has died or hangs, because a service has one process.
void Keeper::accept() {
  auto caller = accepted_at(listening_);
  if (!caller) return;
  if (client_) disconnect();
  client_ = Client{.socket = std::move(caller), .owns_press = !pressed_.value_or(false)};
  client_->messages = loop_.watch(client_->socket.get(), EPOLLIN, [this](std::uint32_t) { read_messages(); });
  watched_.on_contact(loop_.now());
  show();
}

void Keeper::disconnect() {
  client_.reset();
  watched_.on_gone(loop_.now());
  tick_.call_at(loop_.now());
}

void Keeper::read_messages() {
  std::array<char, kLongestMessage> bytes{};
  for (int i = 0; client_ && i < kHeardAtOnce; ++i) {
    const ssize_t size = recv(client_->socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_TRUNC);
    // If the peer closed with unread data, ECONNRESET is reported before its last messages.
    if (size < 0 && (errno == ECONNRESET || errno == EINTR)) continue;
    if (size < 0 && errno == EAGAIN) break;
    if (size <= 0) {
      disconnect();
    } else {
      const auto length = static_cast<std::size_t>(size);
      handle(length > bytes.size() ? std::string_view() : std::string_view(bytes.data(), length));
    }
  }
  show();
}

void Keeper::handle(std::string_view message) {
  const auto told = parse_message(message);
  if (told) return std::visit([this](const auto& each) { handle(each); }, *told);
  if (!std::exchange(complained_, true)) {
    world_.complain("unknown message from aditd, connection closed: " + told.error());
  }
  disconnect();
}

void Keeper::handle(const LightRequest& message) {
  watched_.on_lights(message.lit, loop_.now());
  complained_ = false;
}

/// A line can be opened only once, so the old lines are closed first.
void Keeper::configure(const settings::Panel& panel) {
  edges_ = {};
  button_.reset();
  painter_.set_lines(nullptr);
  PanelDevices held = world_.open(panel);
  painter_.set_lines(std::move(held.lines));
  button_ = std::move(held.button);
  used_ = panel;
  watch_button();
}

void Keeper::watch_button() {
  pressed_ = button_ ? std::nullopt : std::optional(false);
  if (!button_) return;
  edges_ = loop_.watch(button_->descriptor(), EPOLLIN, [this](std::uint32_t) {
    check_button();
    send_changes();
  });
  check_button();
}

/// Losing the button cancels a press. A button that is pressed when it is back, or at the start, counts as
/// not pressed until it is released.
void Keeper::check_button() {
  const auto level = button_->is_pressed();
  log_button(level);
  const bool is_first = !pressed_;
  pressed_ = level ? std::optional(*level) : std::nullopt;
  if (!pressed_) return;
  if (is_first && *pressed_) world_.complain("button is pressed at the start: release it before use");
  if (client_ && (is_first || !*pressed_)) client_->owns_press = !*pressed_;
}

void Keeper::log_button(const std::expected<bool, std::string>& level) {
  if (std::exchange(button_broken_, !level) == !level) return;
  world_.complain(level ? "button works again" : "cannot read the button, retrying: " + level.error());
}

/// Also reads a held button, because a chip that has vanished reports no release and aditd counts the time
/// until the factory reset. While aditd warns of the reset, it sends lights twenty times a second.
void Keeper::show() {
  if (pressed_.value_or(false)) check_button();
  paint();
  send_changes();
}

void Keeper::paint() {
  const Instant now = loop_.now();
  const Frame frame = watched_.frame(now);
  painter_.show(frame.lit, now);
  if (painter_.has_turned()) {
    world_.complain(painter_.trouble().empty() ? "the lights work again"
                                               : "cannot set the lights, retrying: " + painter_.trouble());
  }
  std::optional<Instant> next = painter_.next();
  if (frame.lasts) {
    const Instant ends = now + *frame.lasts + Milliseconds(1);  // timers are rounded down
    next = std::min(ends, next.value_or(ends));
  }
  tick_.cancel();
  if (next) tick_.call_at(*next);
}

/// A press that began before aditd connected counts as not pressed until it is released.
void Keeper::send_changes() {
  if (!client_) return;
  const ButtonState button = pressed_ ? ButtonState{*pressed_ && client_->owns_press} : ButtonState{};
  if (std::exchange(client_->told_button, button) != button) send_message(message_of(button));
  const LightsState lights{painter_.trouble()};
  if (client_ && std::exchange(client_->told_lights, lights) != lights) send_message(message_of(lights));
}

/// Closes the connection if the message cannot be sent, so that a release is never skipped.
void Keeper::send_message(const std::string& message) {
  const int flags = MSG_DONTWAIT | MSG_NOSIGNAL;
  if (send(client_->socket.get(), message.data(), message.size(), flags) < 0) disconnect();
}

}  // namespace adit::panel
