#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace adit::uplink {

/// Parses "Sun, 06 Nov 1994 08:49:37 GMT" (IMF-fixdate, RFC 9110 5.6.7). nullopt if `text` is no such date.
/// Does not check the name of the day.
std::optional<std::chrono::sys_seconds> http_date(const std::string& text);

}  // namespace adit::uplink
