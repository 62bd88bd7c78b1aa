#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace adit::icd {

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
