#include "icd/robot_name.hpp"

#include <algorithm>

namespace adit::icd {
namespace {

bool may_stand_in_a_name(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
         (letter >= '0' && letter <= '9') || letter == '_';
}

}  // namespace

std::optional<RobotName> RobotName::parse(std::string_view text) {
  if (text.empty() || text.size() > kLongest || !std::ranges::all_of(text, may_stand_in_a_name)) {
    return std::nullopt;
  }
  return RobotName(std::string(text));
}

}  // namespace adit::icd
