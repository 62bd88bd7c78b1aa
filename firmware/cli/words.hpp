#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "host/log.hpp"
#include "icd/sentence.hpp"

namespace adit::cli {

/// How a piece of text is to be taken. What it says never hangs on the colour alone.
enum class Tone : std::uint8_t { Plain, Faint, Strong, Good, Warning, Bad };

/// In the tone's colour where there is colour.
std::string painted(const std::string& text, Tone tone, bool colour);

/// How many characters of UTF-8 a text has.
std::size_t width_of(std::string_view text);

/// A line of these parts, strings and numbers. What others wrote is escaped.
template <class... Parts>
std::string line(const Parts&... parts) {
  return host::escaped(icd::sentence(parts...)) + '\n';
}

/// "0.4 s", "12 s", "3 min", "2 h"
std::string duration(double seconds);
/// As a run clock shows it: "1:02:03", "12:34"
std::string clock(double seconds);
/// "812 B", "64 kB", "3.4 MB"
std::string size(std::uint64_t bytes);
/// A Command Post's answer: "accepted", "error 422: its sentence"; "" if it has not answered.
std::string answer_of(int status, const std::string& sentence);
/// With at most `digits` after the point, and none that are zero at the end.
std::string decimal(double number, int digits);

}  // namespace adit::cli
