#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::host {

/// A program's output and its end.
struct Output {
  std::string out, err;  // the last kMostKept bytes of each
  std::string trouble;   // why it could not run or how it ended, without its name; "": it exited 0
  static constexpr std::size_t kMostKept = 1U << 20;
};

/// Runs a program, by its path or found in $PATH, and waits for its end; kills it after `within`. Its
/// environment is only PATH, LC_ALL=C and the system bus. `line` receives each whole line of standard output
/// as it comes.
Output output_of(const std::vector<std::string>& words, std::chrono::milliseconds within,
                 const std::function<void(std::string_view)>& line = {});

/// Runs a program for its effect. An error is one line: the program's name and the output's first line.
std::expected<void, std::string> run_command(const std::vector<std::string>& words,
                                             std::chrono::milliseconds within);

}  // namespace adit::host
