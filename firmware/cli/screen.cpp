#include "cli/screen.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <utility>

#include "cli/watch_text.hpp"

namespace adit::cli {
namespace {

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

}  // namespace

Patience::Patience(bool keys) : keys_(keys) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGWINCH}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, &before_);
  signals_ = loop::FileDescriptor(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
}

Patience::~Patience() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

Patience::Woken Patience::wait(std::chrono::milliseconds longest, int fd) {
  std::array<pollfd, 3> ends{
      {{signals_.get(), POLLIN, 0}, {keys_ ? STDIN_FILENO : -1, POLLIN, 0}, {fd, POLLIN, 0}}};
  if (poll(ends.data(), ends.size(), static_cast<int>(longest.count())) <= 0) return Woken::ByTime;
  signalfd_siginfo signal{};
  if (read(signals_.get(), &signal, sizeof signal) == sizeof signal)
    return signal.ssi_signo == SIGWINCH ? Woken::ByChange : Woken::ToEnd;
  if (ends[1].revents == 0) return Woken::ByTime;
  return ends_by_key() ? Woken::ToEnd : Woken::ByChange;
}

bool Patience::ends_by_key() const {
  std::array<char, 64> keys{};
  const ssize_t size = ::read(STDIN_FILENO, keys.data(), keys.size());
  return size <= 0 || std::string_view(keys.data(), static_cast<std::size_t>(size)).contains('q');
}

Screen::Screen(std::function<void(const std::string&)> print) : print_(std::move(print)) {
  termios now{};
  if (tcgetattr(STDIN_FILENO, &now) == 0) {
    before_ = now;
    now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    now.c_cc[VSUSP] = _POSIX_VDISABLE;  // a stopped program would leave the terminal in this mode
    tcsetattr(STDIN_FILENO, TCSANOW, &now);
  }
  print_(kEnter);
}

Screen::~Screen() {
  print_(kLeave);
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
}

void Screen::show(std::string_view text) const {
  const auto [rows, columns] = size_of_terminal();
  std::string drawn = kHome;
  for (const char c : fitted(text, rows, columns)) {
    if (c == '\n') drawn += kClearLine;
    drawn += c;
  }
  print_(drawn.append(kClearLine).append(kClearRest));
}

}  // namespace adit::cli
