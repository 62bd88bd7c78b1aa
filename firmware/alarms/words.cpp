#include "alarms/words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace adit::alarms {
namespace {

constexpr double kLongest = 1e9;  // seconds; a longer age comes from a clock step

std::int64_t whole(double seconds) {
  return static_cast<std::int64_t>(std::floor(std::clamp(seconds, 0.0, kLongest)));
}

std::string two(std::int64_t number) {
  return (number < 10 ? "0" : "") + std::to_string(number);
}

}  // namespace

std::string age_text(double seconds) {
  const std::int64_t all = whole(seconds);
  if (all < 60) return std::to_string(all) + " s";
  if (all < 3600) return std::to_string(all / 60) + " min";
  return std::to_string(all / 3600) + ":" + two(all / 60 % 60) + " h";
}

std::string clock_text(double seconds) {
  const std::int64_t all = whole(seconds);
  return std::to_string(all / 60) + ":" + two(all % 60);
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

}  // namespace adit::alarms
