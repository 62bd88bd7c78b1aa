#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/log.hpp"

namespace adit::host {

/// Bytes that are not visible ASCII or a space as \xNN, and a backslash as two: so that what a client sent
/// can neither forge a line of the log nor steer a terminal.
std::string escaped(std::string_view text);

/// `message key=value ...`; a value that is empty or holds a space, a quote or "=" stands in quotes.
std::string sentence(std::string_view message, std::span<const Field> fields);

/// `2026-01-31T12:00:00Z warning: message key=value`, without a line end.
std::string plain_line(std::string_view time, Level level, std::string_view message,
                       std::span<const Field> fields);

/// The fields of a journal entry, each as "NAME=value" (systemd.journal-fields(7)).
std::vector<std::string> journal_entry(Level level, std::string_view message, std::span<const Field> fields);

/// Whether `fd` is the stream that $JOURNAL_STREAM, "<device>:<inode>", names (systemd.exec(5)).
bool is_journal(int fd, const char* journal_stream);

}  // namespace adit::host
