#include "rehearsal/robots/console.hpp"

#include <unistd.h>

#include <cstdio>

namespace adit::robots {
namespace {

constexpr const char* kClearLine = "\r\033[K";

void print(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stdout);
  (void)std::fflush(stdout);
}

}  // namespace

Console::Console(bool quiet) : quiet_(quiet), terminal_(isatty(STDOUT_FILENO) == 1) {}

void Console::say(const std::string& line) {
  if (quiet_) return;
  const std::scoped_lock lock(mutex_);
  print(live_.empty() ? line + "\n" : kClearLine + line + "\n" + live_);
}

void Console::live(const std::string& line) {
  if (quiet_) return;
  const std::scoped_lock lock(mutex_);
  if (terminal_) {
    live_ = line;
    print(kClearLine + line);
  } else {
    print(line + "\n");
  }
}

void Console::finish(const std::string& text) {
  const std::scoped_lock lock(mutex_);
  print((live_.empty() ? "" : kClearLine) + text);
  live_.clear();
}

}  // namespace adit::robots
