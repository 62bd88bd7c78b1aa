#pragma once

#include <cstdio>
#include <expected>
#include <span>
#include <string>

#include "command_line/program.hpp"

namespace adit::command_line {

/// Reads the words after the program's name: `--word value` and `--word=value`. An error names its word. Not
/// thread-safe because of getopt_long(3).
[[gnu::cold]] Wrong read(const Program& program, std::span<const char* const> arguments);

/// The program of `program_of` for these options, with --version and --help as the last rows.
template <class Options>
Program full_program(Program (*program_of)(Options&), Options& options) {
  Program program = program_of(options);
  if constexpr (requires { options.version; })
    program.rows.push_back({"--version", "", "print the version", &options.version});
  program.rows.push_back({"--help", "", "print this help", &options.help});
  return program;
}

/// The options that were read. `program_of` returns the rows for the options object that it gets.
template <class Options>
std::expected<Options, std::string> read(Program (*program_of)(Options&),
                                         std::span<const char* const> arguments) {
  Options options;
  if (auto wrong = read(full_program(program_of, options), arguments))
    return std::unexpected(*std::move(wrong));
  return options;
}

/// The exit code if main() must return at once: 2 after an error and the help for a wrong command line, 0
/// after the help or the version (1 if it cannot be printed). nullopt: the program continues.
template <class Options>
std::optional<int> answer(Program (*program_of)(Options&), const char* version,
                          const std::expected<Options, std::string>& options) {
  Options usual;
  const Program program = full_program(program_of, usual);
  if (!options) {
    std::fprintf(stderr, "%s: %s\n%s", program.name.c_str(), options.error().c_str(), help(program).c_str());
    return 2;
  }
  if (options->help) return std::fputs(help(program).c_str(), stdout) < 0 ? 1 : 0;
  if constexpr (requires { options->version; }) {
    if (options->version) return std::printf("%s %s\n", program.name.c_str(), version) < 0 ? 1 : 0;
  }
  return std::nullopt;
}

/// main() of a program. `work` returns the exit code.
template <class Options>
int run(Program (*program_of)(Options&), const char* version, int argc, char** argv,
        int (*work)(const Options&)) {
  const auto options = read(program_of, {argv + 1, argv + argc});
  const auto exit = answer(program_of, version, options);
  return exit ? *exit : work(*options);
}

}  // namespace adit::command_line
