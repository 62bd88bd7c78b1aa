#include "picture/draw.hpp"

#include "codec/map_pieces.hpp"
#include "icd/try.hpp"
#include "picture/aligned_grid.hpp"
#include "picture/draw_parts.hpp"
#include "picture/grid_cells.hpp"
#include "picture/lay.hpp"
#include "picture/turned_grid.hpp"

namespace adit::picture {
namespace {

template <class Drawer>
icd::Checked<std::size_t> draw_by(const icd::OccupancyGrid& grid, const icd::Placement& placement,
                                  const icd::MapData& data, Sheet& sheet, const Between& between) {
  RowCutter cutter{grid.width, grid.height};
  Drawer drawer{grid, placement, sheet};
  ADIT_TRY(codec::for_each_piece(data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
    cutter.feed(piece, [&](std::size_t row, std::size_t column, std::span<const std::uint8_t> cells) {
      drawer.draw(row, column, cells);
    });
    between();
    return {};
  }));
  return drawer.left_out();
}

}  // namespace

icd::Checked<std::size_t> draw_grid(const icd::OccupancyGrid& grid, const icd::MapData& data, Sheet& sheet,
                                    const Between& between) {
  const icd::Placement placement{grid.origin};
  return AlignedGrid::suits(grid, placement) ? draw_by<AlignedGrid>(grid, placement, data, sheet, between)
                                             : draw_by<TurnedGrid>(grid, placement, data, sheet, between);
}

icd::Checked<Drawing> draw(const icd::MapUpdate& map, const Canvas& before, const Between& between) {
  Sheet sheet;
  const auto* grid = std::get_if<icd::OccupancyGrid>(&map.msg);
  auto left_out =
      ADIT_TRY(grid != nullptr ? draw_grid(*grid, map.data, sheet, between)
                               : draw_cloud(std::get<icd::PointCloud2>(map.msg), map.data, sheet, between));
  Drawing drawing;
  drawing.layer = layer_of(map);
  drawing.run = before.run;
  drawing.left_out = left_out;
  lay(sheet, before, drawing);
  return drawing;
}

}  // namespace adit::picture
