#pragma once

#include <termios.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"

namespace adit::cli {

/// Waits while signals that would end the program only end the waiting: SIGINT, SIGTERM and SIGHUP. For a
/// thread that is the only one.
class Patience {
 public:
  enum class Woken : std::uint8_t { ByTime, ByChange, ToEnd };

  /// `keys`: standard input is looked at, too, and a q (or its end) ends the waiting.
  explicit Patience(bool keys);
  ~Patience();
  Patience(const Patience&) = delete;
  Patience& operator=(const Patience&) = delete;

  /// ByTime: or something came at `fd`, unless that is -1. ByChange: the screen has another size.
  Woken wait(std::chrono::milliseconds longest, int fd);

 private:
  bool ends_by_key() const;

  bool keys_;
  sigset_t before_{};
  loop::FileDescriptor signals_;
};

/// A terminal's other screen, without cursor and echo; what was there before is there again afterwards.
class Screen {
 public:
  /// `print` writes to the terminal.
  explicit Screen(std::function<void(const std::string&)> print);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// As much as there is room for.
  void show(std::string_view text) const;

 private:
  std::function<void(const std::string&)> print_;
  std::optional<termios> before_;  // of standard input; nothing: it is no terminal
};

}  // namespace adit::cli
