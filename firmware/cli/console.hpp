#pragma once

#include <functional>
#include <optional>
#include <string>

namespace adit::cli {

/// Who reads what is printed, and may be asked.
struct Console {
  bool colour = false;
  bool screen = false;  // standard output is a terminal
  /// What takes a while gives its lines here as they come, and the rest in the Outcome.
  std::function<void(const std::string&)> print = [](const std::string&) {};
  /// Whether a question is answered with yes; nothing: there is nobody to ask.
  std::function<std::optional<bool>(const std::string&)> ask = [](const std::string&) {
    return std::nullopt;
  };
};

}  // namespace adit::cli
