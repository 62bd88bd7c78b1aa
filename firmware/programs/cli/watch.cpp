#include <poll.h>
#include <sys/ioctl.h>
#include <sys/signalfd.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/reports_csv.hpp"
#include "api/run_view.hpp"
#include "cli/follower.hpp"
#include "cli/handlers.hpp"
#include "cli/status_text.hpp"
#include "cli/table.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::cli {
namespace {

/// Waits; SIGINT, SIGTERM and SIGHUP end the wait instead of the program. Only for a process with one thread.
class SignalPoll {
 public:
  enum class WakeReason : std::uint8_t { ByTime, ByChange, ToEnd };

  /// `keys`: q or the end of standard input also ends the wait.
  explicit SignalPoll(bool keys) : keys_(keys) {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGWINCH}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, &before_);
    signals_ = loop::FileDescriptor(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
  }
  ~SignalPoll() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalPoll(const SignalPoll&) = delete;
  SignalPoll& operator=(const SignalPoll&) = delete;

  /// ByTime: the time is over, or `fd` (unless -1) is readable. ByChange: the screen's size has changed.
  WakeReason wait(std::chrono::milliseconds longest, int fd) {
    std::array<pollfd, 3> ends{
        {{signals_.get(), POLLIN, 0}, {keys_ ? STDIN_FILENO : -1, POLLIN, 0}, {fd, POLLIN, 0}}};
    if (poll(ends.data(), ends.size(), static_cast<int>(longest.count())) <= 0) return WakeReason::ByTime;
    signalfd_siginfo signal{};
    if (read(signals_.get(), &signal, sizeof signal) == sizeof signal)
      return signal.ssi_signo == SIGWINCH ? WakeReason::ByChange : WakeReason::ToEnd;
    if (ends[1].revents == 0) return WakeReason::ByTime;
    return ends_by_key() ? WakeReason::ToEnd : WakeReason::ByChange;
  }

 private:
  static bool ends_by_key() {
    std::array<char, 64> keys{};
    const ssize_t size = ::read(STDIN_FILENO, keys.data(), keys.size());
    return size <= 0 || std::string_view(keys.data(), static_cast<std::size_t>(size)).contains('q');
  }

  bool keys_;
  sigset_t before_{};
  loop::FileDescriptor signals_;
};

// xterm's sequences, known to the Linux console and present terminals.
constexpr const char* kEnter = "\033[?1049h\033[?25l";
constexpr const char* kLeave = "\033[?25h\033[?1049l";
constexpr const char* kHome = "\033[H";
constexpr const char* kClearLine = "\033[K";
constexpr const char* kClearRest = "\033[J";

constexpr std::size_t kUsualRows = 24, kUsualColumns = 80;

std::pair<std::size_t, std::size_t> size_of_terminal() {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0;
  return known ? std::pair<std::size_t, std::size_t>{size.ws_row, size.ws_col}
               : std::pair{kUsualRows, kUsualColumns};
}

/// A terminal's alternate screen, without cursor and echo. The destructor restores the earlier screen.
class Screen {
 public:
  /// `print` writes to the terminal.
  explicit Screen(std::function<void(const std::string&)> print) : print_(std::move(print)) {
    termios now{};
    if (tcgetattr(STDIN_FILENO, &now) == 0) {
      before_ = now;
      now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
      now.c_cc[VSUSP] = _POSIX_VDISABLE;  // a stopped program would leave the terminal in this mode
      tcsetattr(STDIN_FILENO, TCSANOW, &now);
    }
    print_(kEnter);
  }
  ~Screen() {
    print_(kLeave);
    if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Shows as much as fits.
  void show(std::string_view text) const {
    const auto [rows, columns] = size_of_terminal();
    std::string drawn = kHome;
    for (const char c : fit(text, rows, columns)) {
      if (c == '\n') drawn += kClearLine;
      drawn += c;
    }
    print_(drawn.append(kClearLine).append(kClearRest));
  }

 private:
  std::function<void(const std::string&)> print_;
  std::optional<termios> before_;  // of standard input; nullopt: not a terminal
};

using Clock = Follower::Clock;

/// A form of display.
class Display {
 public:
  virtual ~Display() = default;
  virtual void show(const FetchResult& seen) = 0;
  /// Least time between two displays.
  virtual std::chrono::milliseconds spacing() const { return std::chrono::seconds(1); }
};

class JsonDisplay : public Display {
 public:
  explicit JsonDisplay(const Console& console) : console_(console) {}
  void show(const FetchResult& seen) override {
    if (seen) console_.print(codec::write_json(seen->told) + '\n');
  }

 private:
  const Console& console_;
};

class LineDisplay : public Display {
 public:
  explicit LineDisplay(const Console& console) : console_(console) {}
  void show(const FetchResult& seen) override {
    const std::string trouble = seen ? "" : seen.error();
    if (trouble != trouble_)
      console_.print(trouble.empty() ? "Adit answers again\n" : host::escape(trouble) + '\n');
    trouble_ = trouble;
    if (!seen) return;
    console_.print(before_ ? changes_text(*before_, seen->view, console_.colour)
                           : status_text(seen->view, console_.colour) + '\n');
    before_ = seen->view;
  }
  std::chrono::milliseconds spacing() const override { return {}; }  // shows every change

 private:
  const Console& console_;
  std::optional<api::RunView> before_;
  std::string trouble_;
};

class ScreenDisplay : public Display {
 public:
  ScreenDisplay(const Console& console, std::string where)
      : console_(console), where_(std::move(where)), screen_(console.print) {}
  void show(const FetchResult& seen) override {
    if (seen) last_ = seen->view;
    const std::string at = last_ ? "  " + api::iso_time(last_->now) : "";
    const std::string head = "adit watch  " + where_ + at + "  q ends\n";
    const std::string trouble = seen ? ""
                                     : paint("NO ANSWER, the display is old: " + host::escape(seen.error()),
                                             Tone::Bad, console_.colour) +
                                           '\n';
    screen_.show(paint(head, Tone::Faint, console_.colour) + trouble +
                 (last_ ? status_text(*last_, console_.colour) : ""));
  }

 private:
  const Console& console_;
  std::string where_;
  Screen screen_;
  std::optional<api::RunView> last_;
};

std::unique_ptr<Display> make_display(const Options& options, const Console& console, const Adit& adit) {
  if (options.json) return std::make_unique<JsonDisplay>(console);
  if (console.screen) return std::make_unique<ScreenDisplay>(console, to_text(adit.address));
  return std::make_unique<LineDisplay>(console);
}

}  // namespace

Result<Outcome> watch(const Call& call) {
  const auto& [adit, options, console] = call;
  const bool drawn = console.screen && !options.json;
  SignalPoll poll(drawn && isatty(STDIN_FILENO) == 1);
  Follower follower(adit);
  std::unique_ptr<Display> shown;  // created with the first display
  std::optional<FetchResult> seen;
  bool is_news = false;
  Clock::time_point next{};
  while (true) {
    if (auto look = follower.poll()) {
      if (!seen && !*look) return to_failure(look->error());
      seen = std::move(look);
      is_news = true;
    }
    if (!shown && seen) shown = make_display(options, console, adit);
    if (is_news && Clock::now() >= next) {
      shown->show(*seen);
      next = Clock::now() + shown->spacing();
      is_news = false;
    }
    const auto until = is_news ? std::min(next, follower.due()) : follower.due();
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    const auto woken = poll.wait(std::max(left, std::chrono::milliseconds(0)), follower.fd());
    if (woken == SignalPoll::WakeReason::ToEnd) return Outcome{};
    if (woken == SignalPoll::WakeReason::ByChange && drawn && shown) shown->show(*seen);
  }
}

}  // namespace adit::cli
