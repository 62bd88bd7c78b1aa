#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "cli/ask.hpp"

namespace adit::cli {

/// What stands behind a command, or behind its word.
struct Argument {
  const char* shown;  // in the help, and for completion: "NUMBER..."
  const char* noun;   // "a report's number"
  std::size_t least, most;
  std::int64_t largest;  // of a number; 0: it is a text
};

/// The function of a command: one that asks Adit, or one that does not.
struct Run {
  using Asks = Result<Outcome> (*)(const Call& call);
  using Alone = Result<Outcome> (*)(const Options& options, const Console& console);

  constexpr Run(Asks run) : asks(run) {}    // NOLINT(google-explicit-constructor): for the table
  constexpr Run(Alone run) : alone(run) {}  // NOLINT(google-explicit-constructor)

  Asks asks = nullptr;
  Alone alone = nullptr;
};

/// What a command does at a word of its own; "": without one.
struct Form {
  const char* word;
  Run run;
  Argument argument;
  const char* sentence;
  std::string_view options = "";  // that other commands do not take
  bool usual = false;             // also if the line has no word
};

/// A command: what reads, runs, explains, documents and completes it comes from here.
struct CommandRow {
  const char* name;
  const char* sentence;
  std::span<const Form> forms;  // none: it is help
  const char* details;          // as `about` of command_line::Program
  const char* fine;             // what exit status 0 means
  const char* attention;        // and 1; "": it is none of its
  const char* examples;
};

/// The last is help.
std::span<const CommandRow> commands();

}  // namespace adit::cli
