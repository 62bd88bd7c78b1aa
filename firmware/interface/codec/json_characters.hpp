#pragma once

#include <array>
#include <cstddef>

/// Classes of JSON characters by table, for speed.
namespace adit::codec {

/// White space (RFC 8259 section 2).
constexpr bool is_blank(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

inline constexpr std::array<bool, 256> kStandsForItself = [] {
  std::array<bool, 256> plain{};
  for (std::size_t c = 0x20; c < 0x80; ++c) plain[c] = c != '"' && c != '\\';
  return plain;
}();

/// ASCII without special meaning in a string.
constexpr bool is_plain(char c) {
  return kStandsForItself[static_cast<unsigned char>(c)];
}

}  // namespace adit::codec
