#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "icd/text.hpp"

namespace adit::codec {

/// A byte for a sentence: 'x', or byte 0x1f if it is not printable.
inline std::string byte_name(char byte) {
  if (byte > 0x20 && byte < 0x7F) return {'\'', byte, '\''};
  if (byte == ' ') return "a space";
  return "byte 0x" + icd::hex(static_cast<std::uint8_t>(byte));
}

/// Checks UTF-8 byte by byte (Unicode 15, table 3-7: no overlong forms, no surrogates, at most U+10FFFF).
class Utf8Checker {
 public:
  /// False: `byte` is invalid here.
  bool next(std::uint8_t byte) {
    if (left_ == 0 && byte < 0x80) return true;
    return next_of_several(byte);
  }

  /// Position of the first invalid byte, or std::nullopt.
  std::optional<std::size_t> feed(std::string_view bytes);

  /// Whether it is between characters.
  bool complete() const { return left_ == 0; }

 private:
  bool next_of_several(std::uint8_t byte);

  int left_ = 0;               // missing continuation bytes
  std::uint8_t least_ = 0x80;  // range of the next one
  std::uint8_t most_ = 0xBF;
};

bool is_utf8(std::string_view text);

/// Bytes of the first character of `text`, or 0 if it is invalid.
std::size_t character_size(std::string_view text);

/// Requires a scalar value: at most U+10FFFF and no surrogate.
void append_utf8(std::string& text, char32_t character);

}  // namespace adit::codec
