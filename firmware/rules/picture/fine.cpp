#include "picture/fine.hpp"

#include <algorithm>
#include <vector>

#include "picture/draw.hpp"

namespace adit::picture {
namespace {

constexpr std::size_t kStride = std::size_t{kSide} * kFineStep;  // pixels along a block

/// A block as one picture, row by row from the top.
using Block = std::vector<std::uint8_t>;

/// Offset of a tile's upper left pixel in its block.
std::size_t corner_of(const TileIndex& at) {
  const std::size_t place = place_in_block(at);
  const std::size_t column = place % kFineStep, row = kFineStep - 1 - place / kFineStep;
  return (row * kStride + column) * kSide;
}

/// Known cells replace earlier ones; unknown cells leave them.
void overlay_sheet(const Sheet& sheet, Block& block) {
  for (const Sheet::Part& part : sheet.parts()) {
    std::uint8_t* to = block.data() + corner_of(part.at);
    const std::uint8_t* from = part.pixels->data();
    for (int row = 0; row < kSide; ++row, from += kSide, to += kStride) {
      for (std::size_t i = 0; i < kSide; ++i) to[i] = from[i] != 0 ? from[i] : to[i];
    }
  }
}

/// The part of a block that one coarser pixel covers.
class Dot {
 public:
  Dot(Block& block, std::size_t number)
      : corner_(block.data() + (number / kSide * kStride + number % kSide) * kFineStep) {}
  bool is_blank() const {
    std::uint8_t any = 0;
    for (std::size_t row = 0; row < kFineStep; ++row) {
      for (std::size_t i = 0; i < kFineStep; ++i) any |= corner_[row * kStride + i];
    }
    return any == 0;
  }
  void fill(std::uint8_t index) {
    for (std::size_t row = 0; row < kFineStep; ++row) std::fill_n(corner_ + row * kStride, kFineStep, index);
  }

 private:
  std::uint8_t* corner_;
};

void fill_blanks(const Pixels& under, Block& block) {
  for (std::size_t number = 0; number < under.size(); ++number) {
    if (under[number] == 0) continue;
    Dot dot{block, number};
    if (dot.is_blank()) dot.fill(under[number]);
  }
}

Pixels cut(const Block& block, const TileIndex& at) {
  Pixels pixels;
  const std::uint8_t* from = block.data() + corner_of(at);
  for (std::size_t row = 0; row < kSide; ++row) {
    std::copy_n(from + row * kStride, kSide, pixels.data() + row * kSide);
  }
  return pixels;
}

TileIndex tile_of_block(const TileIndex& over, std::size_t place) {
  const int number = static_cast<int>(place);
  return {over.level - 1, over.x * kFineStep + number % kFineStep, over.y * kFineStep + number / kFineStep};
}

}  // namespace

FineBlock draw_fine(const TileIndex& over, std::span<const std::shared_ptr<const ForwardedGrid>> grids,
                    const Tile& under, const Between& between) {
  FineBlock tiles;
  Block block(kStride * kStride);
  for (const auto& grid : grids) {
    Sheet sheet{{.level = over.level - 1,
                 .left = over.x * kFineStep,
                 .bottom = over.y * kFineStep,
                 .tiles = kFineStep}};
    (void)draw_grid(grid->grid, grid->data, sheet, between);
    overlay_sheet(sheet, block);
  }
  Packer packer;
  if (under) {
    Pixels pixels;
    packer.unpack(*under, pixels);
    fill_blanks(pixels, block);
  }
  for (std::size_t place = 0; place < tiles.size(); ++place) {
    const TileIndex at = tile_of_block(over, place);
    const auto lies_there = [area = area_of(at)](const auto& grid) { return touch(grid->area, area); };
    if (std::ranges::any_of(grids, lies_there)) tiles[place] = packer.pack(cut(block, at));
  }
  return tiles;
}

FineBlock draw_fine_from_base(const TileIndex& at,
                              std::span<const std::shared_ptr<const ForwardedGrid>> grids, const Tile& base,
                              const Between& between) {
  const TileIndex over = coarser(at);
  if (over.level == 0) return draw_fine(over, grids, base, between);
  const FineBlock coarse = draw_fine_from_base(over, grids, base, between);
  return draw_fine(over, grids, coarse[place_in_block(over)], between);
}

}  // namespace adit::picture
