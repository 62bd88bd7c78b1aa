#pragma once

#include <string>

namespace adit::icd {

/// "2026-11-23 04:05:06", of seconds since 1970, in UTC, cut off to whole ones; "" where that is no date of
/// the years 1970 to 5138, and for 0.
std::string utc(double seconds);

}  // namespace adit::icd
