#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "codec/gzip.hpp"

namespace adit::codec {

/// A map's data, not compressed.
inline std::vector<std::uint8_t> bytes_of(const icd::MapData& data) {
  std::vector<std::uint8_t> bytes;
  EXPECT_TRUE(for_each_piece(data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
    return {};
  }));
  return bytes;
}

}  // namespace adit::codec
