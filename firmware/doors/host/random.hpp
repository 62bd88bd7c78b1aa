#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "icd/text.hpp"

namespace adit::host {

/// Fills `bytes` with kernel randomness, fit for secrets. Requires at most 256 bytes.
void fill_random(std::span<std::uint8_t> bytes);

template <std::size_t size>
std::array<std::uint8_t, size> random_bytes() {
  std::array<std::uint8_t, size> bytes;
  fill_random(bytes);
  return bytes;
}

/// `size` random bytes as hexadecimal digits.
template <std::size_t size>
std::string random_digits() {
  return icd::hex(random_bytes<size>());
}

}  // namespace adit::host
