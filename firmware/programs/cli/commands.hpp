#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "cli/ask.hpp"
#include "cli/options.hpp"

namespace adit::cli {

/// The arguments of a command or subcommand.
struct Argument {
  const char* shown;  // in help and completion: "NUMBER..."
  const char* noun;   // "a report's number"
  std::size_t least, most;
  std::int64_t largest;  // of a number; 0: a text
};

/// The function of a command, with or without a connection to Adit.
struct Run {
  using Asks = Result<Outcome> (*)(const Call& call);
  using Alone = Result<Outcome> (*)(const Options& options, const Console& console);

  constexpr Run(Asks run) : asks(run) {}    // NOLINT(google-explicit-constructor): for the table
  constexpr Run(Alone run) : alone(run) {}  // NOLINT(google-explicit-constructor)

  Asks asks = nullptr;
  Alone alone = nullptr;
};

/// A subcommand; `word` "": without one.
struct Form {
  const char* word;
  Run run;
  Argument argument;
  const char* sentence;
  std::string_view options = "";  // taken by no other command
  bool usual = false;             // the default if the line has no word
};

/// A command, as data for parsing, running, help, documents and completion.
struct CommandRow {
  const char* name;
  const char* sentence;
  std::span<const Form> forms;  // empty: help
  const char* details;          // as `about` of command_line::Program
  const char* fine;             // meaning of exit status 0
  const char* attention;        // meaning of exit status 1; "": not used
  const char* examples;
};

/// The last one is help.
std::span<const CommandRow> commands();

/// The text of `adit COMMAND --help`; null: of `adit --help`.
[[gnu::cold]] std::string help_text(const CommandRow* command);

/// The line after an error that names the right help.
[[gnu::cold]] std::string see_help(const CommandRow* command);

/// Runs `adit` with the arguments `words`.
Outcome run(std::span<const std::string_view> words, const Console& console = {});

/// Runs the command of a parsed line, except help and version.
Outcome run(const Options& options, const Console& console);

}  // namespace adit::cli
