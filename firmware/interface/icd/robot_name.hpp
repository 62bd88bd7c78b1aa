#pragma once

#include <algorithm>
#include <compare>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "icd/text.hpp"

namespace adit::icd {

/// A robot's name: 1 to 10 letters, digits and underscores (ICD 2), the same in maps and telemetry.
class RobotName {
 public:
  static constexpr std::size_t kLongest = 10;

  /// nullopt if `text` is no robot's name.
  static std::optional<RobotName> parse(std::string_view text) {
    const auto is_word_letter = [](char letter) { return is_letter_or_digit(letter) || letter == '_'; };
    if (text.empty() || text.size() > kLongest || !std::ranges::all_of(text, is_word_letter))
      return std::nullopt;
    return RobotName(std::string(text));
  }

  const std::string& text() const { return text_; }
  friend auto operator<=>(const RobotName&, const RobotName&) = default;

 private:
  explicit RobotName(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

/// "" without a name.
inline std::string text_of(const std::optional<RobotName>& name) {
  return name ? name->text() : "";
}

}  // namespace adit::icd
