#include "cli/words.hpp"

#include <algorithm>
#include <cstdio>

namespace adit::cli {
namespace {

/// ECMA-48 8.3.117 (SGR), in the order of Tone.
constexpr const char* kCodes[] = {"", "\033[2m", "\033[1m", "\033[32m", "\033[33m", "\033[1;31m"};

constexpr double kLongestTime = 1e9;  // seconds; a larger value is an error of the peer

}  // namespace

std::string painted(const std::string& text, Tone tone, bool colour) {
  if (!colour || tone == Tone::Plain || text.empty()) return text;
  return kCodes[static_cast<std::size_t>(tone)] + text + "\033[0m";
}

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<std::uint8_t>(byte) & 0xc0u) != 0x80u; }));
}

std::string duration(double seconds) {
  const double time = std::clamp(seconds, 0.0, kLongestTime);
  if (time < 9.95) return decimal(time, 1) + " s";
  if (time < 99.5) return decimal(time, 0) + " s";
  if (time < 5970) return decimal(time / 60, 0) + " min";
  return decimal(time / 3600, 0) + " h";
}

std::string clock(double seconds) {
  const auto whole = static_cast<long>(std::clamp(seconds, 0.0, kLongestTime));
  char text[32];
  int length = 0;
  if (whole < 3600) {
    length = std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  } else {
    length = std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  }
  return {text, static_cast<std::size_t>(length)};
}

std::string size(std::uint64_t bytes) {
  const auto number = static_cast<double>(bytes);
  if (bytes < 1000) return std::to_string(bytes) + " B";
  if (number < 999.5e3) return decimal(number / 1e3, 0) + " kB";
  return decimal(number / 1e6, 1) + " MB";
}

std::string answer_of(int status, const std::string& sentence) {
  if (status == 0) return sentence;
  const std::string answer = status < 300 ? "accepted" : "error " + std::to_string(status);
  return sentence.empty() ? answer : answer + ": " + sentence;
}

std::string decimal(double number, int digits) {
  char text[400];
  const int length = std::snprintf(text, sizeof text, "%.*f", digits, number);
  std::string written(text, static_cast<std::size_t>(length));
  if (written.find('.') != std::string::npos) {
    written.erase(written.find_last_not_of('0') + 1);
    if (written.ends_with('.')) written.pop_back();
  }
  return written == "-0" ? "0" : written;
}

}  // namespace adit::cli
