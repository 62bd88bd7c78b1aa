#pragma once

#include <functional>
#include <optional>
#include <string>

namespace adit::cli {

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
