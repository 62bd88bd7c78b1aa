#pragma once

#include <string>

namespace adit::icd {

/// Seconds since 1970 as "2026-11-23 04:05:06" in UTC, without fractions. "" for 0, negative values, values
/// above 1e11 (the year 5138) and NaN.
std::string utc(double seconds);

}  // namespace adit::icd
