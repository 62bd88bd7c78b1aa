#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "icd/redaction.hpp"

namespace adit::host {

enum class Level : int { Error = 3, Warning = 4, Notice = 5, Info = 6, Debug = 7 };  // syslog's (RFC 5424)

/// "error", "warning", ...
std::string_view name_of(Level level);

/// A field of a log record: name in lower_case ("report", "status"), value as text. Never a token.
using Field = std::pair<std::string_view, std::string>;

/// A record that is remembered.
struct Record {
  std::uint64_t seq = 0;  // counts all that was ever logged by this process
  double at = 0;          // seconds since 1970, on the wall clock
  Level level = Level::Info;
  std::string message;
  std::vector<std::pair<std::string, std::string>> fields;  // those that are not empty
};

/// The one logger. Thread-safe. Message and fields make one line, `message name=value ...`, with everything
/// escaped that could forge another. Under journald (stderr is the stream that $JOURNAL_STREAM names) each
/// field is also recorded by itself, unescaped, as ADIT_<NAME>; elsewhere the line goes to stderr after the
/// time and the level. Memory remembers the last of them for the page.
void log(Level level, std::string_view message, std::initializer_list<Field> fields = {});

/// The same for whoever is at the console alone: the message is remembered without its fields.
void tell_console(Level level, std::string_view message, std::initializer_list<Field> fields);

/// From now on these are struck out of all that is logged, but not of what the console is told.
void keep_out_of_log(icd::Redaction redaction);
/// A text for whoever reads the log, without them.
std::string without_secrets(std::string text);

/// What is remembered of the records after the one of that number, oldest first.
std::vector<Record> remembered(std::uint64_t after);

/// How many records there were: the number of the last.
std::uint64_t logged();

/// A record as one line, as it stands in the log.
std::string line_of(const Record& record);

/// What a client sent, so that it can neither forge a line nor steer a terminal: visible characters of UTF-8
/// and blanks as they are, each byte of all else as \xNN, and a backslash as two.
std::string escaped(std::string_view text);
/// The same for a terminal without UTF-8, of what is escaped: each byte of a character that is not ASCII.
std::string in_ascii(std::string_view text);

}  // namespace adit::host
