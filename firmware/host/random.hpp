#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "icd/hex.hpp"

namespace adit::host {

/// Fills `bytes` with the kernel's randomness, which is good for secrets. Requires at most 256 of them.
void fill_random(std::span<std::uint8_t> bytes);

template <std::size_t size>
std::array<std::uint8_t, size> random_bytes() {
  std::array<std::uint8_t, size> bytes;
  fill_random(bytes);
  return bytes;
}

/// That many bytes, as two hexadecimal digits each.
template <std::size_t size>
std::string random_digits() {
  return icd::hex(random_bytes<size>());
}

}  // namespace adit::host
