#pragma once

#include <functional>
#include <optional>
#include <string>

namespace adit::cli {

enum class Exit : int { Fine = 0, Attention = 1, Unable = 2 };

/// A command's output and exit status.
struct Outcome {
  Exit exit = Exit::Fine;
  std::string out, err;
};

/// The terminal or other receiver of the output.
struct Console {
  bool colour = false;
  bool screen = false;  // standard output is a terminal
  /// Prints lines of a long command at once; the rest goes into the Outcome.
  std::function<void(const std::string&)> print = [](const std::string&) {};
  /// Whether the user answers yes; std::nullopt: no user.
  std::function<std::optional<bool>(const std::string&)> ask = [](const std::string&) {
    return std::nullopt;
  };
};

}  // namespace adit::cli
