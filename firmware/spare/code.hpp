#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace adit::spare {

/// The code of an export: 16 digits, which the box that makes it draws. As much to guess as a password that
/// nobody finds out by trying (2^53), and typed with gloves on.
inline constexpr std::size_t kCodeDigits = 16;

/// `random`: of the kernel's.
std::string draw_code(const std::array<std::uint8_t, kCodeDigits>& random);

/// "1234 5678 9012 3456", to be read and typed.
std::string spoken(std::string_view code);

/// Nothing unless there are 16 digits in it, with blanks and hyphens anywhere between them.
std::optional<std::string> code_in(std::string_view typed);

}  // namespace adit::spare
