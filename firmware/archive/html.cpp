#include "archive/html.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace adit::archive {

std::string fixed(double number, int digits) {
  char text[64];
  constexpr double kMost = 1e15;
  if (!std::isfinite(number)) return "-";
  const int size = std::snprintf(text, sizeof text, "%.*f", digits, std::clamp(number, -kMost, kMost));
  return {text, static_cast<std::size_t>(std::clamp(size, 0, 63))};
}

std::string utc(double seconds) {
  if (!(seconds > 0) || seconds > 1e11) return "";
  const auto whole = static_cast<std::time_t>(seconds);
  std::tm parts{};
  char text[32];
  if (gmtime_r(&whole, &parts) == nullptr) return "";
  return {text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts)};
}

std::string lasted(double seconds) {
  if (!(seconds > 0) || seconds > 1e9) return "-";
  const auto whole = static_cast<long>(seconds);
  char text[48];
  const int size =
      std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return {text, static_cast<std::size_t>(std::clamp(size, 0, 47))};
}

std::string base64_of(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i) group = group << 8 | (i < count ? bytes[at + i] : 0U);
    for (std::size_t i = 0; i < 4; ++i) text += i <= count ? kLetters[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

}  // namespace adit::archive
