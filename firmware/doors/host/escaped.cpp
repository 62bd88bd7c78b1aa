#include <algorithm>
#include <cstdint>

#include "codec/utf8.hpp"
#include "host/log.hpp"
#include "icd/hex.hpp"

namespace adit::host {
namespace {

/// Characters that control or deceive a terminal: C1 controls, characters without width or that change the
/// writing direction, Unicode's line ends, tags (Unicode 15, 23.2 to 23.9).
struct Span {
  char32_t first, last;
};
constexpr Span kUnseen[] = {{0x80, 0x9f},     {0xad, 0xad},      {0x61c, 0x61c},   {0x180e, 0x180e},
                            {0x200b, 0x200f}, {0x2028, 0x202e},  {0x2060, 0x206f}, {0xfeff, 0xfeff},
                            {0xfff9, 0xffff}, {0xe0000, 0xeffff}};

std::size_t length_by(std::uint8_t first) {
  return first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

/// The code of a UTF-8 character of several bytes.
char32_t decoded(std::string_view character) {
  const auto first = static_cast<std::uint8_t>(character[0]);
  char32_t code = first & (0xffu >> (character.size() + 1));
  for (const char c : character.substr(1)) code = code << 6 | (static_cast<std::uint8_t>(c) & 0x3fu);
  return code;
}

/// Length of the first character in bytes. 0: invisible, or not UTF-8.
std::size_t visible(std::string_view text) {
  const auto first = static_cast<std::uint8_t>(text[0]);
  const std::string_view character = text.substr(0, length_by(first));
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  if (character.size() < length_by(first) || !codec::is_utf8(character)) return 0;
  const bool unseen = std::ranges::any_of(kUnseen, [code = decoded(character)](const Span& span) {
    return code >= span.first && code <= span.last;
  });
  return unseen ? 0 : character.size();
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = visible(text);
    if (text[0] == '\\') {
      safe += "\\\\";
    } else if (length > 0) {
      safe += text.substr(0, length);
    } else {
      safe += "\\x" + icd::hex(static_cast<std::uint8_t>(text[0]));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return safe;
}

std::string in_ascii(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (static_cast<std::uint8_t>(c) < 0x80) {
      safe += c;
    } else {
      safe += "\\x" + icd::hex(static_cast<std::uint8_t>(c));
    }
  }
  return safe;
}

}  // namespace adit::host
