#pragma once

#include <cstdint>
#include <expected>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "icd/bearer_token.hpp"

namespace adit::host {

enum class Level : int { Error = 3, Warning = 4, Notice = 5, Info = 6, Debug = 7 };  // syslog (RFC 5424)

/// "error", "warning", ...
std::string_view name_of(Level level);

/// A field of a log record: name in lower_case ("report", "status"), value as text. Never a token.
using Field = std::pair<std::string_view, std::string>;

struct Record {
  std::uint64_t seq = 0;  // number among all records of this process
  double at = 0;          // seconds since 1970, wall clock
  Level level = Level::Info;
  std::string message;
  std::vector<std::pair<std::string, std::string>> fields;  // without empty ones
};

/// Logs a record. Thread-safe. Message and fields make one line, `message name=value ...`, escaped so that it
/// cannot forge another. Under journald (stderr is the stream in $JOURNAL_STREAM) each field is also recorded
/// unescaped as ADIT_<NAME>. Elsewhere the line goes to stderr after time and level. The last records are
/// stored for the page.
void log(Level level, std::string_view message, std::initializer_list<Field> fields = {});

/// Logs an error as "why". Returns whether `done` has none.
template <class T, class Error>
bool log_failure(Level level, std::string_view message, const std::expected<T, Error>& done) {
  if constexpr (requires { done.error().sentence; }) {
    if (!done) log(level, message, {{"why", done.error().sentence}});
  } else {
    if (!done) log(level, message, {{"why", done.error()}});
  }
  return done.has_value();
}

/// As log(), for a person at the console: secrets stay in the text, and the stored record has no fields.
void log_to_console(Level level, std::string_view message, std::initializer_list<Field> fields);

/// Removes these secrets from all later records, except from log_to_console().
void keep_out_of_log(icd::Redaction redaction);
std::string strip_secrets(std::string text);

/// The stored records with a larger number, oldest first.
std::vector<Record> records_after(std::uint64_t after);

/// Number of the last record, which counts all records.
std::uint64_t last_record_number();

std::string line_of(const Record& record);

/// Escapes a client's text, so that it cannot forge a line or control a terminal. Visible UTF-8 characters
/// and blanks stay, other bytes become \xNN, and a backslash is doubled.
std::string escape(std::string_view text);
/// Escapes an escaped text for a terminal without UTF-8: each byte of a character outside ASCII.
std::string to_ascii(std::string_view text);

}  // namespace adit::host
