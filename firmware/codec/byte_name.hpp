#pragma once

#include <string>

namespace adit::codec {

/// A byte in a sentence: 'x', or byte 0x1f where it cannot be printed.
inline std::string byte_name(char byte) {
  if (byte > 0x20 && byte < 0x7F) return {'\'', byte, '\''};
  if (byte == ' ') return "a space";
  constexpr const char* kDigits = "0123456789abcdef";
  const auto value = static_cast<unsigned char>(byte);
  return std::string("byte 0x") + kDigits[value >> 4] + kDigits[value & 0xF];
}

}  // namespace adit::codec
