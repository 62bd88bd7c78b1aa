#pragma once

#include <termios.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"

namespace adit::cli {

/// Waits; SIGINT, SIGTERM and SIGHUP end the wait instead of the program. Only for a process with one thread.
class Patience {
 public:
  enum class Woken : std::uint8_t { ByTime, ByChange, ToEnd };

  /// `keys`: q or the end of standard input also ends the wait.
  explicit Patience(bool keys);
  ~Patience();
  Patience(const Patience&) = delete;
  Patience& operator=(const Patience&) = delete;

  /// ByTime: the time is over, or `fd` (unless -1) is readable. ByChange: the screen's size has changed.
  Woken wait(std::chrono::milliseconds longest, int fd);

 private:
  bool ends_by_key() const;

  bool keys_;
  sigset_t before_{};
  loop::FileDescriptor signals_;
};

/// A terminal's alternate screen, without cursor and echo. The destructor restores the earlier screen.
class Screen {
 public:
  /// `print` writes to the terminal.
  explicit Screen(std::function<void(const std::string&)> print);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Shows as much as fits.
  void show(std::string_view text) const;

 private:
  std::function<void(const std::string&)> print_;
  std::optional<termios> before_;  // of standard input; nullopt: not a terminal
};

}  // namespace adit::cli
