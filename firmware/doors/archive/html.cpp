#include "archive/html.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace adit::archive {

std::string fixed(double number, int digits) {
  char text[64];
  constexpr double kMost = 1e15;
  if (!std::isfinite(number)) return "-";
  const int size = std::snprintf(text, sizeof text, "%.*f", digits, std::clamp(number, -kMost, kMost));
  return {text, static_cast<std::size_t>(std::clamp(size, 0, 63))};
}

std::string lasted(double seconds) {
  if (!(seconds > 0) || seconds > 1e9) return "-";
  const auto whole = static_cast<long>(seconds);
  char text[48];
  const int size =
      std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return {text, static_cast<std::size_t>(std::clamp(size, 0, 47))};
}

}  // namespace adit::archive
