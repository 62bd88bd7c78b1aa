#include "icd/robot_name.hpp"

#include <algorithm>

#include "icd/text.hpp"

namespace adit::icd {
namespace {

bool is_word_letter(char letter) {
  return is_letter_or_digit(letter) || letter == '_';
}

}  // namespace

std::optional<RobotName> RobotName::parse(std::string_view text) {
  if (text.empty() || text.size() > kLongest || !std::ranges::all_of(text, is_word_letter)) {
    return std::nullopt;
  }
  return RobotName(std::string(text));
}

}  // namespace adit::icd
