#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace adit::icd {

/// Without these characters at both ends.
constexpr std::string_view trim(std::string_view text, std::string_view space = " \t\r\n") {
  text.remove_prefix(std::min(text.find_first_not_of(space), text.size()));
  return text.substr(0, text.find_last_not_of(space) + 1);
}

/// Removes and returns the text before the next `end`; removes the `end`. Without an `end`: all of it.
constexpr std::string_view cut(std::string_view& text, char end) {
  const std::string_view piece = text.substr(0, text.find(end));
  text.remove_prefix(std::min(text.size(), piece.size() + 1));
  return piece;
}

/// "a, b, c": the text of each item, if it has one.
template <class Items, class TextOf = std::identity>
std::string join_words(const Items& items, TextOf text_of = {}) {
  std::string list;
  for (const auto& item : items) {
    const auto& text = std::invoke(text_of, item);
    if (std::string_view(text).empty()) continue;
    list.append(list.empty() ? "" : ", ").append(text);
  }
  return list;
}

/// The number that all of `text` is, by std::from_chars(). `base`: of a whole number, if it is not 10.
template <class Number, class... Base>
std::optional<Number> number_in(std::string_view text, Base... base) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base...);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

/// In lower case, if it is an ASCII letter.
constexpr char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

constexpr bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

/// Of ASCII.
constexpr bool is_letter_or_digit(char letter) {
  return is_digit(letter) || (lower(letter) >= 'a' && lower(letter) <= 'z');
}

/// True if both are equal except for the case of ASCII letters.
constexpr bool equals_ignoring_case(std::string_view one, std::string_view other) {
  return std::ranges::equal(one, other, {}, lower, lower);
}

/// Whether a character of UTF-8 begins with this byte.
constexpr bool begins_character(char byte) {
  return (static_cast<std::uint8_t>(byte) & 0xC0) != 0x80;
}

/// The characters of a UTF-8 text.
constexpr std::size_t count_characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

/// The first whole characters of a UTF-8 text, at most `most` bytes.
constexpr std::string_view beginning_of(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text;
  while (most > 0 && !begins_character(text[most])) --most;
  return text.substr(0, most);
}

/// Two hexadecimal digits for each byte: "0aff".
inline std::string hex(std::span<const std::uint8_t> bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}
inline std::string hex(std::uint8_t byte) {
  return hex({&byte, 1});
}

}  // namespace adit::icd
