#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/log.hpp"

namespace adit::host {

/// `message key=value ...`; a value that holds a space, a quote or "=" stands in quotes, an empty one is left
/// out.
std::string sentence(std::string_view message, std::span<const Field> fields);

/// "2026-01-31T12:00:00Z" of seconds since 1970.
std::string time_text(double at);

/// `2026-01-31T12:00:00Z warning: message key=value`, without a line end.
std::string plain_line(std::string_view time, Level level, std::string_view message,
                       std::span<const Field> fields);

/// The fields of a journal entry, each that is not empty as "NAME=value" (systemd.journal-fields(7)).
std::vector<std::string> journal_entry(Level level, std::string_view message, std::span<const Field> fields);

/// Whether `fd` is the stream that $JOURNAL_STREAM, "<device>:<inode>", names (systemd.exec(5)).
bool is_journal(int fd, const char* journal_stream);

}  // namespace adit::host
