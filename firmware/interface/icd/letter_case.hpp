#pragma once

#include <algorithm>
#include <string_view>

namespace adit::icd {

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
constexpr bool same_but_for_case(std::string_view one, std::string_view other) {
  return std::ranges::equal(one, other, {}, lower, lower);
}

}  // namespace adit::icd
