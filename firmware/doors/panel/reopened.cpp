#include "panel/reopened.hpp"

#include <sys/epoll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <optional>
#include <utility>

#include "loop/file_descriptor.hpp"

namespace adit::panel {
namespace {

using OpenLines = std::function<std::expected<std::unique_ptr<Lines>, std::string>()>;
using OpenButton = std::function<std::expected<std::unique_ptr<ButtonLine>, std::string>()>;

constexpr const char* kNotWatched = "the button cannot be watched";

class ReopenedLines final : public Lines {
 public:
  ReopenedLines(OpenLines open, std::function<std::unique_ptr<Lines>()> stand_in,
                std::function<Instant()> now)
      : open_(std::move(open)), make_stand_in_(std::move(stand_in)), now_(std::move(now)) {}

  std::expected<void, std::string> set(const Lit& lit) override {
    const Instant now = now_();
    if (lines_) {
      auto done = lines_->set(lit);
      if (done) fails_since_.reset();
      if (done || now - fails_since_.value_or(now) < kReopen) {
        if (!done) fails_since_ = fails_since_.value_or(now);
        return done;
      }
      lines_.reset();  // first, because a line can be opened only once
    } else if (now < due_) {
      return stand_in(lit);
    }
    return reopen(lit, now);
  }

 private:
  std::expected<void, std::string> reopen(const Lit& lit, Instant now) {
    due_ = now + kReopen;
    fails_since_.reset();
    auto opened = open_();
    if (!opened) {
      why_ = std::move(opened.error());
      return stand_in(lit);
    }
    stand_in_.reset();
    lines_ = std::move(*opened);
    auto done = lines_->set(lit);
    if (!done) fails_since_ = now;
    return done;
  }

  /// A failure of the stand-in is ignored; the lines' own error is reported.
  std::expected<void, std::string> stand_in(const Lit& lit) {
    if (!stand_in_ && make_stand_in_) stand_in_ = make_stand_in_();
    if (stand_in_) [[maybe_unused]]
      const auto shown = stand_in_->set(lit);
    return std::unexpected(why_);
  }

  OpenLines open_;
  std::function<std::unique_ptr<Lines>()> make_stand_in_;
  std::function<Instant()> now_;
  std::unique_ptr<Lines> lines_, stand_in_;
  std::optional<Instant> fails_since_;  // of the open lines
  Instant due_{};                       // when to open them, if they are closed
  std::string why_;                     // the error, if they are closed
};

class ReopenedButton final : public ButtonLine {
 public:
  ReopenedButton(OpenButton open, loop::FileDescriptor epoll, loop::FileDescriptor timer)
      : open_(std::move(open)), timer_(std::move(timer)), epoll_(std::move(epoll)) {
    reopen();
  }

  /// Stays the same across lines: readable if the present line or the timer is.
  int descriptor() const override { return epoll_.get(); }

  std::expected<bool, std::string> is_pressed() override {
    if (is_time() && !line_) reopen();
    if (!line_) return std::unexpected(why_);
    auto level = line_->is_pressed();
    if (!level) close_line(level.error());
    return level;
  }

 private:
  bool is_time() {
    std::uint64_t times = 0;
    return read(timer_.get(), &times, sizeof times) == sizeof times;
  }

  void close_line(const std::string& why) {
    epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, line_->descriptor(), nullptr);
    line_.reset();
    why_ = why;
  }

  void reopen() {
    auto opened = open_();
    if (!opened) {
      why_ = std::move(opened.error());
      return;
    }
    epoll_event wanted{.events = EPOLLIN, .data = {}};
    if (epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, (*opened)->descriptor(), &wanted) == 0) {
      line_ = std::move(*opened);
    } else {
      why_ = panel_error(kNotWatched, errno).error();
    }
  }

  OpenButton open_;
  loop::FileDescriptor timer_, epoll_;
  std::unique_ptr<ButtonLine> line_;
  std::string why_;  // the error, if it is closed
};

/// Readable every `pace`.
loop::FileDescriptor timer_of(std::chrono::milliseconds pace) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(pace);
  const timespec each{.tv_sec = seconds.count(), .tv_nsec = std::chrono::nanoseconds(pace - seconds).count()};
  const itimerspec times{.it_interval = each, .it_value = each};
  loop::FileDescriptor timer(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
  if (timer && timerfd_settime(timer.get(), 0, &times, nullptr) != 0) return {};
  return timer;
}

}  // namespace

std::unique_ptr<Lines> reopened_lines(OpenLines open, std::function<std::unique_ptr<Lines>()> stand_in,
                                      std::function<Instant()> now) {
  return std::make_unique<ReopenedLines>(std::move(open), std::move(stand_in), std::move(now));
}

std::expected<std::unique_ptr<ButtonLine>, std::string> reopened_button(OpenButton open,
                                                                        std::chrono::milliseconds pace) {
  loop::FileDescriptor epoll(epoll_create1(EPOLL_CLOEXEC)), timer = timer_of(pace);
  epoll_event wanted{.events = EPOLLIN, .data = {}};
  if (!epoll || !timer || epoll_ctl(epoll.get(), EPOLL_CTL_ADD, timer.get(), &wanted) != 0)
    return panel_error(kNotWatched, errno);
  return std::make_unique<ReopenedButton>(std::move(open), std::move(epoll), std::move(timer));
}

namespace {

std::unique_ptr<Lines> hold_lines(const settings::Panel& settings, const std::string& consumer,
                                  const std::string& simulated_file) {
  const auto make = [simulated_file] {
    return simulated_file.empty() ? nullptr : make_simulated_lines(simulated_file);
  };
  if (settings.is_simulated()) return make();
  return reopened_lines([settings, consumer] { return open_gpio(settings, consumer); }, make);
}

/// A simulated button never replaces a real one, because it would not prove that a person is at the box.
std::expected<std::unique_ptr<ButtonLine>, std::string> hold_button(const settings::Panel& settings,
                                                                    const std::string& consumer,
                                                                    const std::string& simulated_file) {
  if (settings.is_simulated()) {
    if (simulated_file.empty()) return nullptr;
    return simulated_button(simulated_file + ".button");
  }
  if (settings.button.empty()) return nullptr;
  return reopened_button([settings, consumer] { return open_gpio_button(settings, consumer); });
}

}  // namespace

PanelDevices hold(const settings::Panel& settings, const std::string& consumer, const std::string& simulated,
                  const std::function<void(const std::string&)>& complain) {
  auto button = hold_button(settings, consumer, simulated);
  if (!button) complain("cannot use the button: " + button.error());
  return {hold_lines(settings, consumer, simulated), button ? std::move(*button) : nullptr};
}

}  // namespace adit::panel
