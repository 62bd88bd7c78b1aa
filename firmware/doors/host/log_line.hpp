#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/log.hpp"

namespace adit::host {

/// `message key=value ...`. A value with a space, a quote or "=" is quoted; an empty value is left out.
std::string sentence(std::string_view message, std::span<const Field> fields);

/// "2026-01-31T12:00:00Z". `at`: seconds since 1970.
std::string time_text(double at);

/// `2026-01-31T12:00:00Z warning: message key=value`, without a newline.
std::string plain_line(std::string_view time, Level level, std::string_view message,
                       std::span<const Field> fields);

/// The fields of a journal entry as "NAME=value" (systemd.journal-fields(7)), without empty ones.
std::vector<std::string> journal_entry(Level level, std::string_view message, std::span<const Field> fields);

/// Whether `fd` is the stream in $JOURNAL_STREAM, "<device>:<inode>" (systemd.exec(5)).
bool is_journal(int fd, const char* journal_stream);

}  // namespace adit::host
