#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::host {

/// What a program said, and how it ended.
struct Output {
  std::string out, err;  // the last kMostKept bytes of each
  std::string trouble;   // "" where it exited 0; or why it could not be run, or how it ended
  static constexpr std::size_t kMostKept = 1U << 20;
};

/// Runs a program, by its path or found in $PATH, with an environment of PATH, LC_ALL=C and the system bus
/// alone, and waits for its end; kills it after `within`. `line` is told each whole line of its standard
/// output as it comes.
Output output_of(const std::vector<std::string>& words, std::chrono::milliseconds within,
                 const std::function<void(std::string_view)>& line = {});

}  // namespace adit::host
