#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace adit::cli {

enum class Command : std::uint8_t {
  Status,
  Watch,
  Reports,
  Rejected,
  Run,
  Runs,
  Settings,
  Course,
  Identify,
  Network,
  Clock,
  Spare,
  Ledger,
  Test,
  Update,
  Check,
  Complete,
  Help
};

/// What a command is to do.
enum class Verb : std::uint8_t {
  List,
  Show,
  Send,
  Hold,
  Withdraw,
  Settle,
  Resubmit,
  Export,
  Discard,
  New,
  Check,
  Apply,
  Confirm,
  Set,
  Revert,
  Reports,
  Rejected,
  Courses,
  Runs,
  Keys,
  Report,
  Delete,
  Take,
  Resume,
  Dump
};

/// What an argument may be, for the completion of shells: `adit complete` lists all but files.
enum class Among : std::uint8_t { Anything, Files, Reports, Rejected, Courses, Runs, Keys, Commands };

/// What stands behind a command, or behind its word.
struct Argument {
  const char* shown;  // in the help: "NUMBER..."
  const char* noun;   // "a report's number"
  std::size_t least, most;
  std::int64_t largest;  // of a number; 0: it is a text
  Among among = Among::Anything;
};

/// What a command does at a word of its own; "": without one.
struct Form {
  const char* word;
  Verb verb;
  Argument argument;
  const char* sentence;
  std::string_view options = "";  // that other commands do not take
  bool usual = false;             // also where no word is said
};

/// All that is to be known of a command, to read and to explain it.
struct CommandRow {
  Command command;
  const char* name;
  const char* sentence;
  std::span<const Form> forms;
  const char* details;    // as `about` of command_line::Program
  const char* fine;       // what exit status 0 means
  const char* attention;  // and 1; "": it is none of its
  const char* examples;
};

std::span<const CommandRow> commands();

}  // namespace adit::cli
