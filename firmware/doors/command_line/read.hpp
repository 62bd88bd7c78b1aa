#pragma once

#include <expected>
#include <span>
#include <string>

#include "command_line/program.hpp"

namespace adit::command_line {

/// Reads the words after the program's name: `--word value` and `--word=value`. An error names its word. Not
/// thread-safe because of getopt_long(3).
[[gnu::cold]] Wrong read(const Program& program, std::span<const char* const> arguments);

/// The options that were read. `program_of` returns the rows for the options object that it gets.
template <class Options>
std::expected<Options, std::string> read(Program (*program_of)(Options&),
                                         std::span<const char* const> arguments) {
  Options options;
  if (auto wrong = read(program_of(options), arguments)) return std::unexpected(*std::move(wrong));
  return options;
}

}  // namespace adit::command_line
