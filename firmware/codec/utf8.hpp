#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace adit::codec {

/// Checks UTF-8 (Unicode 15, table 3-7: no overlong forms, no surrogates, nothing over U+10FFFF) byte by
/// byte.
class Utf8Checker {
 public:
  /// False: `byte` cannot stand here.
  bool next(std::uint8_t byte) {
    if (left_ == 0 && byte < 0x80) return true;
    return next_of_several(byte);
  }

  /// Where the first byte is that cannot stand there, if any.
  std::optional<std::size_t> feed(std::string_view bytes);

  /// Not in the middle of a character.
  bool complete() const { return left_ == 0; }

 private:
  bool next_of_several(std::uint8_t byte);

  int left_ = 0;               // continuation bytes to come
  std::uint8_t least_ = 0x80;  // what the next of them may be
  std::uint8_t most_ = 0xBF;
};

bool is_utf8(std::string_view text);

/// Requires a scalar value: at most U+10FFFF and no surrogate.
void append_utf8(std::string& text, char32_t character);

}  // namespace adit::codec
