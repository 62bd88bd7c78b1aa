#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace adit::spare {

/// Digits of an export's code, which the exporting box draws. 16 digits are as hard to guess as a strong
/// password (2^53) and can be typed with gloves.
inline constexpr std::size_t kCodeDigits = 16;

/// `random`: from the kernel.
std::string draw_code(const std::array<std::uint8_t, kCodeDigits>& random);

/// "1234 5678 9012 3456", for people.
std::string spoken(std::string_view code);

/// std::nullopt unless the text has 16 digits, with blanks and hyphens anywhere between them.
std::optional<std::string> code_in(std::string_view typed);

}  // namespace adit::spare
