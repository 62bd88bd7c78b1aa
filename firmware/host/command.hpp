#pragma once

#include <chrono>
#include <expected>
#include <string>
#include <vector>

namespace adit::host {

/// Runs a program (found by $PATH, or by its path) with these words and waits for its end; kills it after
/// `within`. An error is a sentence with what it said last, on one line.
std::expected<void, std::string> run_command(const std::vector<std::string>& words,
                                             std::chrono::milliseconds within);

}  // namespace adit::host
