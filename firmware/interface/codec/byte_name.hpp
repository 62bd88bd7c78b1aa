#pragma once

#include <string>

#include "icd/hex.hpp"

namespace adit::codec {

/// A byte for a sentence: 'x', or byte 0x1f if it is not printable.
inline std::string byte_name(char byte) {
  if (byte > 0x20 && byte < 0x7F) return {'\'', byte, '\''};
  if (byte == ' ') return "a space";
  return "byte 0x" + icd::hex(static_cast<std::uint8_t>(byte));
}

}  // namespace adit::codec
