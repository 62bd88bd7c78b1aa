#include "codec/utf8.hpp"

#include "icd/require.hpp"

namespace adit::codec {

bool Utf8Checker::next_of_several(std::uint8_t byte) {
  if (left_ > 0) {
    if (byte < least_ || byte > most_) return false;
    least_ = 0x80;
    most_ = 0xBF;
    --left_;
    return true;
  }
  if (byte < 0xC2 || byte > 0xF4) return false;
  left_ = byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
  if (byte == 0xE0) least_ = 0xA0;  // below: overlong
  if (byte == 0xED) most_ = 0x9F;   // above: surrogates
  if (byte == 0xF0) least_ = 0x90;  // below: overlong
  if (byte == 0xF4) most_ = 0x8F;   // above: over U+10FFFF
  return true;
}

std::optional<std::size_t> Utf8Checker::feed(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (!next(static_cast<std::uint8_t>(bytes[i]))) return i;
  }
  return std::nullopt;
}

std::size_t character_size(std::string_view text) {
  Utf8Checker checker;
  for (std::size_t i = 0; i < text.size() && checker.next(static_cast<std::uint8_t>(text[i])); ++i) {
    if (checker.complete()) return i + 1;
  }
  return 0;
}

bool is_utf8(std::string_view text) {
  Utf8Checker checker;
  return !checker.feed(text) && checker.complete();
}

void append_utf8(std::string& text, char32_t character) {
  icd::require(character <= 0x10FFFF && (character < 0xD800 || character > 0xDFFF));
  const auto continuation = [&](int shift) {
    text.push_back(static_cast<char>(0x80 | ((character >> shift) & 0x3F)));
  };
  if (character < 0x80) {
    text.push_back(static_cast<char>(character));
  } else if (character < 0x800) {
    text.push_back(static_cast<char>(0xC0 | (character >> 6)));
    continuation(0);
  } else if (character < 0x10000) {
    text.push_back(static_cast<char>(0xE0 | (character >> 12)));
    continuation(6);
    continuation(0);
  } else {
    text.push_back(static_cast<char>(0xF0 | (character >> 18)));
    continuation(12);
    continuation(6);
    continuation(0);
  }
}

}  // namespace adit::codec
