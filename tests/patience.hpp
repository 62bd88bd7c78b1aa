#pragma once

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace adit {

/// ADIT_PATIENCE, a number of at least 1, which toolchain/ctest sets on a slow machine; 1 if it is not set.
/// Anything else ends the process.
inline double patience() {
  static const double factor = [] {
    const char* const set = std::getenv("ADIT_PATIENCE");
    const std::string_view text = set == nullptr ? "1" : set;
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc{} && end == text.data() + text.size() && number >= 1 && std::isfinite(number))
      return number;
    std::fprintf(stderr, "ADIT_PATIENCE: expected a number of at least 1, not '%s'\n", text.data());
    std::exit(2);
  }();
  return factor;
}

/// A time-out of a test, or a deadline of the product that a test shortened, times ADIT_PATIENCE.
template <class Rep, class Period>
std::chrono::duration<Rep, Period> patient(std::chrono::duration<Rep, Period> timeout) {
  return std::chrono::duration_cast<std::chrono::duration<Rep, Period>>(timeout * patience());
}

}  // namespace adit
