#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace adit::archive {

/// With so many digits behind the point.
std::string fixed(double number, int digits);

/// "2026-11-23 04:05:06", of seconds since 1970, in UTC; "" for 0.
std::string utc(double seconds);
/// "1:02:03", of seconds; "-" where there are none.
std::string lasted(double seconds);

std::string base64_of(std::span<const std::uint8_t> bytes);

}  // namespace adit::archive
