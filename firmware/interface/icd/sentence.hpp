#pragma once

#include <concepts>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

#include "icd/status.hpp"

namespace adit::icd {

/// A number in the fewest digits that identify the double.
std::string number_text(double number);

/// The same with ".0" if there would be neither point nor exponent, so that it never reads as a whole number.
std::string real_text(double number);

/// "812 B", "64 kB", "3.4 MB"
std::string size_text(std::uint64_t bytes);

/// A sender's text for a sentence: in quotation marks, on one line, cut after 40 bytes.
std::string quote_text(std::string_view text);

/// For HTML, also for an attribute in double quotes. A newline or tab becomes a blank, other controls U+FFFD.
std::string escape_html(std::string_view text);

inline void append_part(std::string& sentence, std::string_view part) {
  sentence += part;
}
inline void append_part(std::string& sentence, std::integral auto part) {
  sentence += std::to_string(part);
}
inline void append_part(std::string& sentence, double part) {
  sentence += number_text(part);
}

/// Joins strings and numbers.
template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::string whole;
  (append_part(whole, parts), ...);
  return whole;
}

/// 422 (ICD 4.1) with a sentence of these parts.
template <class... Parts>
std::unexpected<Refusal> unprocessable(const Parts&... parts) {
  return std::unexpected(Refusal{Status::UnprocessableEntity, sentence(parts...)});
}
/// The same. The setting `key`, a literal, can prevent this refusal.
template <class... Parts>
std::unexpected<Refusal> unprocessable_by_setting(std::string_view key, const Parts&... parts) {
  return std::unexpected(
      Refusal{.status = Status::UnprocessableEntity, .sentence = sentence(parts...), .setting = key});
}

/// The same with 409: the present state forbids it.
template <class... Parts>
std::unexpected<Refusal> conflict(const Parts&... parts) {
  return std::unexpected(Refusal{Status::Conflict, sentence(parts...)});
}

template <class... Parts>
std::unexpected<Refusal> refuse(Status status, const Parts&... parts) {
  return std::unexpected(Refusal{status, sentence(parts...)});
}

/// Seconds since 1970 as "2026-11-23 04:05:06". "": 0, negative, NaN, or above 1e11 (the year 5138).
std::string utc(double seconds);

}  // namespace adit::icd
