#include "panel/keeper.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <utility>

#include "panel/unix_socket.hpp"

namespace adit::panel {
namespace {

constexpr int kHeardAtOnce =
    64;  // messages, so that nobody who tells without end keeps the lights from their time

bool same(const settings::Panel& one, const settings::Panel& other) {
  return message_of(ToUse{one}) == message_of(ToUse{other});
}

}  // namespace

Keeper::Keeper(loop::Loop& loop, loop::FileDescriptor listening, std::optional<settings::Panel> boards,
               World world)
    : loop_(loop),
      world_(std::move(world)),
      watched_(loop.now()),
      knows_board_(boards.has_value()),
      listening_(std::move(listening)),
      tick_(loop.timer([this] { paint(); })),
      callers_(loop.watch(listening_.get(), EPOLLIN, [this](std::uint32_t) { accept(); })) {
  if (boards) use(*boards);
  paint();
}

/// Whoever connected before has died, or hangs: a service has one process.
void Keeper::accept() {
  auto caller = accepted_at(listening_);
  if (!caller) return;
  if (client_) lose();
  client_ = std::move(*caller);
  words_ = loop_.watch(client_.get(), EPOLLIN, [this](std::uint32_t) { hear(); });
  is_for_him_ = !pressed_;
  watched_.came(loop_.now());
  paint();
}

void Keeper::lose() {
  words_ = {};
  client_ = {};
  watched_.gone(loop_.now());
}

void Keeper::hear() {
  std::array<char, kLongestMessage> bytes{};
  for (int i = 0; client_ && i < kHeardAtOnce; ++i) {
    const ssize_t size = recv(client_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_TRUNC);
    // Whoever left without having read all is told of before what he had said: that comes next.
    if (size < 0 && (errno == ECONNRESET || errno == EINTR)) continue;
    if (size < 0 && errno == EAGAIN) break;
    if (size <= 0) {
      lose();
    } else {
      const auto length = static_cast<std::size_t>(size);
      take(length > bytes.size() ? std::string_view() : std::string_view(bytes.data(), length));
    }
  }
  paint();
}

void Keeper::take(std::string_view message) {
  const auto told = parse_message(message);
  if (told) return std::visit([this](const auto& each) { take(each); }, *told);
  if (!std::exchange(complained_, true)) {
    world_.complain("what aditd tells is not understood, it is let go of: " + told.error());
  }
  lose();
}

void Keeper::take(const ToLight& message) {
  watched_.lights(message.lit, loop_.now());
  complained_ = false;
}

void Keeper::take(const ToEnd&) {
  watched_.ends(loop_.now());
}

void Keeper::take(const ToUse& message) {
  if (!knows_board_ && !(used_ && same(*used_, message.panel))) use(message.panel);
}

/// A line can be had once: the old ones are let go of first.
void Keeper::use(const settings::Panel& panel) {
  edges_ = {};
  held_ = {};
  held_ = world_.open(panel);
  used_ = panel;
  shown_.reset();
  watch_button();
}

void Keeper::watch_button() {
  pressed_ = is_for_him_ = false;
  if (!held_.button) return;
  edges_ = loop_.watch(held_.button->descriptor(), EPOLLIN, [this](std::uint32_t) { look_at_button(); });
  look_at_button();
  if (pressed_) world_.complain("the button is held since before the start: let it go before it is used");
  is_for_him_ = !pressed_;
}

void Keeper::look_at_button() {
  const auto level = held_.button->pressed();
  if (!level) {
    world_.complain("the button cannot be read, and is left alone from now on: " + level.error());
    edges_ = {};
    held_.button.reset();
  }
  if (level.value_or(false) == std::exchange(pressed_, level.value_or(false))) return;
  tell_of_button();
}

/// One that is held since before he came is none to him until it was let go.
void Keeper::tell_of_button() {
  if (client_ && is_for_him_) {
    const std::string_view message = message_of_button(pressed_);
    const int flags = MSG_DONTWAIT | MSG_NOSIGNAL;
    if (send(client_.get(), message.data(), message.size(), flags) < 0)
      lose();  // a release is never left out
  }
  if (!pressed_) is_for_him_ = true;
}

void Keeper::paint() {
  const Frame frame = watched_.frame(loop_.now());
  if (held_.lines && shown_ != frame.lit) {
    const auto set = held_.lines->set(frame.lit);
    if (!set && !std::exchange(broken_, true)) world_.complain(set.error());
    if (set) broken_ = false;
    shown_ = frame.lit;
  }
  if (frame.lasts) {
    tick_.call_at(loop_.now() + *frame.lasts + Milliseconds(1));  // what is left of one was cut off
  } else {
    tick_.cancel();
  }
}

}  // namespace adit::panel
