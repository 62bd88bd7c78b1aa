#pragma once

#include <array>
#include <cstddef>

namespace adit::codec {

inline constexpr std::array<bool, 256> kStandsForItself = [] {
  std::array<bool, 256> plain{};
  for (std::size_t c = 0x20; c < 0x80; ++c) plain[c] = c != '"' && c != '\\';
  return plain;
}();

/// ASCII that stands for itself in a string of JSON.
inline bool is_plain(char c) {
  return kStandsForItself[static_cast<unsigned char>(c)];
}

}  // namespace adit::codec
