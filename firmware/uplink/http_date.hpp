#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace adit::uplink {

/// Of "Sun, 06 Nov 1994 08:49:37 GMT" (IMF-fixdate, RFC 9110 5.6.7); nothing where it is none. The day's name
/// is not looked at.
std::optional<std::chrono::sys_seconds> http_date(const std::string& text);

}  // namespace adit::uplink
