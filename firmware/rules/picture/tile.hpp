#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "picture/world.hpp"

namespace adit::picture {

/// The colour index of each pixel of a tile, row by row from the top as in a PNG. 0: unknown.
using Pixels = std::array<std::uint8_t, kSide * kSide>;

/// Index of a pixel in Pixels. x to the right, y up.
inline constexpr std::size_t index_of(int x, int y) {
  return static_cast<std::size_t>(kSide - 1 - y) * kSide + static_cast<std::size_t>(x);
}

/// A tile as stored: the content of a PNG's IDAT chunk (a zlib stream of unfiltered rows), without the
/// palette, which all tiles share.
struct Packed {
  std::vector<std::uint8_t> deflated;
  std::uint32_t crc = 0;  // of the chunk, by PNG 5.5; equal tiles have equal values
};
using Tile = std::shared_ptr<const Packed>;  // null: blank

/// Packs many tiles with one zlib stream, because creating a stream is expensive. For one thread.
class Packer {
 public:
  Packer();
  ~Packer();
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  Tile pack(const Pixels& pixels);
  void unpack(const Packed& packed, Pixels& pixels);
  /// False if a tile read from disk is damaged.
  bool is_whole(const Packed& packed);

 private:
  struct Streams;
  std::unique_ptr<Streams> streams_;
  std::vector<std::uint8_t> rows_, made_;
};

}  // namespace adit::picture
