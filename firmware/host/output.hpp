#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::host {

/// What a program said, and how it ended.
struct Output {
  std::string out, err;  // the last kMostKept bytes of each
  std::string trouble;   // "" where it exited 0; or why it could not be run, or how it ended; not its name
  static constexpr std::size_t kMostKept = 1U << 20;
};

/// Runs a program, by its path or found in $PATH, with an environment of PATH, LC_ALL=C and the system bus
/// alone, and waits for its end; kills it after `within`. `line` is told each whole line of its standard
/// output as it comes.
Output output_of(const std::vector<std::string>& words, std::chrono::milliseconds within,
                 const std::function<void(std::string_view)>& line = {});

/// The same, where nothing but its end counts. An error is a sentence with its name and what it said first,
/// on one line.
std::expected<void, std::string> run_command(const std::vector<std::string>& words,
                                             std::chrono::milliseconds within);

}  // namespace adit::host
