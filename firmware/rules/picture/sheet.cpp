#include "picture/sheet.hpp"

#include <algorithm>

namespace adit::picture {

Sheet::Sheet(const Frame& frame)
    : frame_(frame), places_(static_cast<std::size_t>(frame.tiles) * static_cast<std::size_t>(frame.tiles)) {}

std::uint16_t Sheet::made(int x, int y) {
  if (parts_.size() == kMostTiles) return kNone;
  parts_.push_back({{frame_.level, x, y}, std::make_unique<Pixels>()});
  return static_cast<std::uint16_t>(parts_.size());
}

std::size_t Sheet::raise(int x, int y, std::span<const std::uint8_t> row) {
  const auto is_known = [](std::uint8_t index) { return index != 0; };
  std::size_t left_out = 0;
  while (!row.empty()) {
    const auto piece = row.first(std::min(row.size(), static_cast<std::size_t>(kSide - (x & (kSide - 1)))));
    if (std::ranges::any_of(piece, is_known)) {
      if (Pixels* pixels = tile(x >> 8, y >> 8)) {
        std::uint8_t* to = pixels->data() + index_of(x & (kSide - 1), y & (kSide - 1));
        for (std::size_t i = 0; i < piece.size(); ++i) to[i] = std::max(to[i], piece[i]);
      } else {
        left_out += static_cast<std::size_t>(std::ranges::count_if(piece, is_known));
      }
    }
    x += static_cast<int>(piece.size());
    row = row.subspan(piece.size());
  }
  return left_out;
}

}  // namespace adit::picture
