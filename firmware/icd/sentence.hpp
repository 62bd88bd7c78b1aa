#pragma once

#include <concepts>
#include <expected>
#include <string>
#include <string_view>

#include "icd/status.hpp"

namespace adit::icd {

/// A number as a sentence shows it: in the fewest digits that say which double it is.
std::string number_text(double number);

/// The same, and never as a whole number: with ".0" where there would be neither point nor exponent.
std::string real_text(double number);

/// What a sender wrote, for a sentence: in quotation marks, on one line, at most 40 bytes of it.
std::string in_quotes(std::string_view text);

inline void append_part(std::string& sentence, std::string_view part) {
  sentence += part;
}
inline void append_part(std::string& sentence, std::integral auto part) {
  sentence += std::to_string(part);
}
inline void append_part(std::string& sentence, double part) {
  sentence += number_text(part);
}

/// Its parts, strings and numbers, one after the other.
template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::string whole;
  (append_part(whole, parts), ...);
  return whole;
}

/// 422 (ICD 4.1) with that sentence.
template <class... Parts>
std::unexpected<Refusal> unprocessable(const Parts&... parts) {
  return std::unexpected(Refusal{Status::UnprocessableEntity, sentence(parts...)});
}
/// The same, if the setting `key` can prevent it: a literal.
template <class... Parts>
std::unexpected<Refusal> unprocessable_by_setting(std::string_view key, const Parts&... parts) {
  return std::unexpected(
      Refusal{.status = Status::UnprocessableEntity, .sentence = sentence(parts...), .setting = key});
}

}  // namespace adit::icd
