#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "picture/tile.hpp"

namespace adit::picture {

/// A square of whole tiles of one level.
struct Frame {
  int level = 0;
  int left = -kWorldTiles, bottom = -kWorldTiles;  // its first tile
  int tiles = 2 * kWorldTiles;                     // along each side

  double metres_per_pixel() const { return picture::metres_per_pixel(level); }
  int first_x() const { return left * kSide; }  // pixels
  int first_y() const { return bottom * kSide; }
  int side() const { return tiles * kSide; }
};

/// One map within a frame, at the scale of its level. Each pixel has the highest index that falls on it. A
/// tile takes 64 KiB once a pixel in it is known, and there are at most kMostTiles.
class Sheet {
 public:
  static constexpr std::size_t kMostTiles = 512;  // about 2 square kilometres

  struct Part {
    TileIndex at;
    std::unique_ptr<Pixels> pixels;
  };

  /// By default: the whole world at the scale of the base.
  explicit Sheet(const Frame& frame = {});

  const Frame& frame() const { return frame_; }
  /// Raises a pixel of the frame to `index`. False if its tile would be one too many.
  bool raise(int x, int y, std::uint8_t index) {
    Pixels* pixels = tile(x >> 8, y >> 8);
    if (pixels == nullptr) return false;
    std::uint8_t& pixel = (*pixels)[index_of(x & (kSide - 1), y & (kSide - 1))];
    if (index > pixel) pixel = index;
    return true;
  }

  /// Raises a row of pixels from x, y on. The result is the number of known pixels without a tile.
  std::size_t raise(int x, int y, std::span<const std::uint8_t> row);

  std::span<const Part> parts() const { return parts_; }

 private:
  static_assert(kSide == 1 << 8);
  static constexpr std::uint16_t kNone = 0;

  /// Null if it would be one too many.
  Pixels* tile(int x, int y) {
    const auto at = static_cast<std::size_t>(y - frame_.bottom) * static_cast<std::size_t>(frame_.tiles) +
                    static_cast<std::size_t>(x - frame_.left);
    if (at != last_at_) {
      if (places_[at] == kNone) places_[at] = made(x, y);
      last_ = places_[at] == kNone ? nullptr : parts_[places_[at] - 1U].pixels.get();
      last_at_ = at;
    }
    return last_;
  }
  std::uint16_t made(int x, int y);

  Frame frame_;
  std::vector<Part> parts_;
  std::size_t last_at_ = SIZE_MAX;  // index of the last tile, because the next is often the same
  Pixels* last_ = nullptr;
  std::vector<std::uint16_t> places_;  // for each tile of the frame: its place in parts_ plus 1
};

}  // namespace adit::picture
