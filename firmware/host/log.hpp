#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace adit::host {

enum class Level : int { Error = 3, Warning = 4, Notice = 5, Info = 6, Debug = 7 };  // syslog's (RFC 5424)

/// A field of a log record: name in lower_case ("report", "status"), value as text. Never a token.
using Field = std::pair<std::string_view, std::string>;

/// The one logger. Thread-safe. Message and fields make one line, `message name=value ...`, with everything
/// escaped that could forge another. Under journald (stderr is the stream that $JOURNAL_STREAM names) each
/// field is also recorded by itself, unescaped, as ADIT_<NAME>; elsewhere the line goes to stderr after the
/// time and the level.
void log(Level level, std::string_view message, std::initializer_list<Field> fields = {});

/// Bytes that are not visible ASCII or a space as \xNN, and a backslash as two: so that what a client sent
/// can neither forge a line nor steer a terminal.
std::string escaped(std::string_view text);

/// Records less important than this are left out; Info at first.
void set_least(Level level);

}  // namespace adit::host
