#include "picture/draw.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <span>
#include <vector>

#include "codec/gzip.hpp"
#include "icd/geometry.hpp"
#include "icd/mapping.hpp"
#include "icd/require.hpp"
#include "icd/try.hpp"
#include "picture/palette.hpp"

namespace adit::picture {
namespace {

/// The colour index of a cell; 0 if it is unknown.
inline std::uint8_t index_of_cell(std::uint8_t value) {
  return value <= icd::kMostOccupied ? static_cast<std::uint8_t>(value + 1) : std::uint8_t{0};
}

inline std::size_t known_cells(std::span<const std::uint8_t> cells) {
  return static_cast<std::size_t>(
      std::ranges::count_if(cells, [](std::uint8_t value) { return value <= icd::kMostOccupied; }));
}

/// Cuts a grid's data into rows, piece by piece. Calls `visit(row, column, cells)` with a part of one row.
class RowCutter {
 public:
  RowCutter(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}

  template <class Visit>
  void feed(std::span<const std::uint8_t> piece, Visit visit) {
    while (!piece.empty() && row_ < height_) {
      const auto cells = piece.first(std::min(piece.size(), width_ - column_));
      visit(row_, column_, cells);
      piece = piece.subspan(cells.size());
      column_ += cells.size();
      if (column_ < width_) continue;
      column_ = 0;
      ++row_;
    }
  }

 private:
  std::size_t width_, height_, row_ = 0, column_ = 0;
};

/// Draws a grid whose rows run along x, as most do. A pixel shows the cells whose centres lie in it. If cells
/// are larger than pixels, it shows the cell that contains the pixel's centre.
class AlignedGrid {
 public:
  static bool can_draw(const icd::OccupancyGrid& grid, const icd::Placement& placement);
  /// Requires can_draw().
  AlignedGrid(const icd::OccupancyGrid& grid, const icd::Placement& placement, Sheet& sheet);

  /// Draws a part of a row. Call it in the order of the data.
  void draw(std::size_t row, std::size_t column, std::span<const std::uint8_t> cells);
  std::size_t left_out() const { return left_out_ + without_tile_; }

 private:
  struct Cells {
    std::uint32_t begin = 0, end = 0;
  };
  /// The cells that each pixel shows, along x or y. Two pixels show the same cells, or none in common.
  struct Axis {
    /// The pixels of the frame along this axis.
    struct Pixels {
      double metres = 0;  // each
      int from = 0, side = 0;
      /// The pixel at `place`, limited to the frame's first pixel and the one after its last.
      int at(double place) const;
    };
    Axis(double origin, double metres_per_cell, std::uint32_t count, const Pixels& pixels);
    std::size_t begin() const { return cells.empty() ? 0 : cells.front().begin; }
    std::size_t end() const { return cells.empty() ? 0 : cells.back().end; }
    int first_pixel = 0;
    std::vector<Cells> cells;  // of first_pixel and those after it; never an empty range
  };
  void finish_row(std::size_t row);
  void make_line();

  Sheet& sheet_;
  Axis columns_, rows_;
  std::size_t width_;
  std::vector<std::uint8_t> highest_;  // per shown column: highest index in the rows of a pixel
  std::vector<std::uint8_t> line_;     // the same for each pixel
  std::size_t next_ = 0;               // index of the first of rows_.cells not yet drawn
  std::size_t left_out_ = 0;
  std::size_t without_tile_ = 0;  // pixels
};

/// Draws a rotated grid cell by cell. A small cell sets the pixel at its centre. A larger cell sets the
/// pixels of several points, evenly spread over the cell so that no gaps are left.
class TurnedGrid {
 public:
  TurnedGrid(const icd::OccupancyGrid& grid, const icd::Placement& placement, Sheet& sheet);

  void draw(std::size_t row, std::size_t column, std::span<const std::uint8_t> cells);
  std::size_t left_out() const { return left_out_; }

 private:
  struct Step {
    double x = 0, y = 0;  // in pixels
  };
  bool is_near(double x, double y) const;
  void draw_dot(double x, double y, std::uint8_t index);

  Sheet& sheet_;
  Step origin_, column_, row_;  // the grid's corner, and the steps from cell to cell
  double reach_ = 0;            // from a cell's centre to its corner, in pixels
  int side_ = 1;                // points along a cell's side; 0: cells are too large to be drawn
  std::size_t dabs_ = 0;
  std::size_t left_out_ = 0;
};

/// The far end of a row or column may lie this far off its axis, in metres.
constexpr double kMostSkew = kPixel / 10;
/// In cells: a larger distance than the rounding errors of a pixel's border. A cell whose centre lies on a
/// border belongs to the next pixel. Without this, a grid that grows would flicker.
constexpr double kRounding = 1e-3;
/// A lattice with this spacing, in pixels, has a point in every pixel at any angle.
constexpr double kGapless = 1 / std::numbers::sqrt2;

}  // namespace

int AlignedGrid::Axis::Pixels::at(double place) const {
  return static_cast<int>(
      std::clamp(std::floor(place / metres), static_cast<double>(from), static_cast<double>(from + side)));
}

AlignedGrid::Axis::Axis(double origin, double metres_per_cell, std::uint32_t count, const Pixels& pixels)
    : first_pixel(pixels.at(origin)) {
  const auto cell = [count](double number) {
    return static_cast<std::uint32_t>(std::clamp(number, 0.0, static_cast<double>(count)));
  };
  const auto first_centre_from = [&](double metres) {
    return cell(std::ceil((metres - origin) / metres_per_cell - 0.5 - kRounding));
  };
  const int last = std::min(pixels.at(origin + count * metres_per_cell), pixels.from + pixels.side - 1);
  for (int pixel = first_pixel; pixel <= last; ++pixel) {
    Cells shown{first_centre_from(pixel * pixels.metres), first_centre_from((pixel + 1) * pixels.metres)};
    if (shown.begin == shown.end) {
      const double centre = std::floor(((pixel + 0.5) * pixels.metres - origin) / metres_per_cell);
      if (centre >= 0 && centre < count) shown = {cell(centre), cell(centre) + 1};
    }
    if (shown.begin < shown.end) {
      cells.push_back(shown);
    } else if (cells.empty()) {
      ++first_pixel;  // less than half a cell of the grid lies in this pixel
    }
  }
}

bool AlignedGrid::can_draw(const icd::OccupancyGrid& grid, const icd::Placement& placement) {
  const auto& turn = placement.turn;
  const double along_x = grid.width * grid.resolution, along_y = grid.height * grid.resolution;
  return turn[0][0] > 0.5 && turn[1][1] > 0.5 && std::abs(turn[1][0]) * along_x < kMostSkew &&
         std::abs(turn[0][1]) * along_y < kMostSkew;
}

AlignedGrid::AlignedGrid(const icd::OccupancyGrid& grid, const icd::Placement& placement, Sheet& sheet)
    : sheet_(sheet),
      columns_(placement.shift.x, grid.resolution * placement.turn[0][0], grid.width,
               {sheet.frame().metres_per_pixel(), sheet.frame().first_x(), sheet.frame().side()}),
      rows_(placement.shift.y, grid.resolution * placement.turn[1][1], grid.height,
            {sheet.frame().metres_per_pixel(), sheet.frame().first_y(), sheet.frame().side()}),
      width_(grid.width) {
  icd::require(can_draw(grid, placement));
  if (columns_.end() - columns_.begin() > kMostColumns) columns_.cells.clear();
  highest_.resize(columns_.end() - columns_.begin());
  line_.resize(columns_.cells.size());
}

void AlignedGrid::draw(std::size_t row, std::size_t column, std::span<const std::uint8_t> cells) {
  const std::size_t end = column + cells.size();
  const std::size_t from = std::clamp(columns_.begin(), column, end),
                    to = std::clamp(columns_.end(), from, end);
  if (row < rows_.begin() || row >= rows_.end() || from == to) {
    left_out_ += known_cells(cells);
    return;
  }
  left_out_ += known_cells(cells.first(from - column)) + known_cells(cells.subspan(to - column));
  const std::uint8_t* cell = cells.data() + (from - column);
  std::uint8_t* highest = highest_.data() + (from - columns_.begin());
  for (std::size_t i = 0; i < to - from; ++i) highest[i] = std::max(highest[i], index_of_cell(cell[i]));
  if (end >= columns_.end()) finish_row(row);
}

void AlignedGrid::finish_row(std::size_t row) {
  if (next_ == rows_.cells.size() || rows_.cells[next_].end != row + 1) return;
  make_line();
  for (; next_ < rows_.cells.size() && rows_.cells[next_].end == row + 1; ++next_) {
    if (without_tile_ > kMostDabs) continue;
    without_tile_ += sheet_.raise(columns_.first_pixel, rows_.first_pixel + static_cast<int>(next_), line_);
  }
  std::ranges::fill(highest_, std::uint8_t{0});
}

void AlignedGrid::make_line() {
  const std::size_t first = columns_.begin();
  for (std::size_t pixel = 0; pixel < line_.size(); ++pixel) {
    const auto [begin, end] = columns_.cells[pixel];
    std::uint8_t highest = 0;
    for (std::size_t column = begin; column < end; ++column) {
      highest = std::max(highest, highest_[column - first]);
    }
    line_[pixel] = highest;
  }
}

TurnedGrid::TurnedGrid(const icd::OccupancyGrid& grid, const icd::Placement& placement, Sheet& sheet)
    : sheet_(sheet) {
  const auto& turn = placement.turn;
  const double pixel = sheet.frame().metres_per_pixel(), cell = grid.resolution / pixel;
  origin_ = {placement.shift.x / pixel, placement.shift.y / pixel};
  column_ = {turn[0][0] * cell, turn[1][0] * cell};
  row_ = {turn[0][1] * cell, turn[1][1] * cell};
  reach_ = cell / std::numbers::sqrt2;
  side_ = cell > kLargestTurnedCell ? 0 : std::max(1, static_cast<int>(std::ceil(cell / kGapless)));
}

/// True if a cell with this centre may reach into the frame.
bool TurnedGrid::is_near(double x, double y) const {
  const Frame& frame = sheet_.frame();
  const auto near = [&](double at, int from) {
    return at + reach_ >= from && at - reach_ < from + frame.side();  // false for NaN
  };
  return near(x, frame.first_x()) && near(y, frame.first_y());
}

void TurnedGrid::draw_dot(double x, double y, std::uint8_t index) {
  const Frame& frame = sheet_.frame();
  const auto inside = [&](double at, int from) { return at >= from && at < from + frame.side(); };
  if (!inside(x, frame.first_x()) || !inside(y, frame.first_y())) {
    ++left_out_;
    return;
  }
  const auto pixel = [](double at, int from) { return static_cast<int>(at - from) + from; };  // rounds down
  if (!sheet_.raise(pixel(x, frame.first_x()), pixel(y, frame.first_y()), index)) ++left_out_;
}

void TurnedGrid::draw(std::size_t row, std::size_t column, std::span<const std::uint8_t> cells) {
  const std::size_t dabs = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
  const auto r = static_cast<double>(row);
  const double first_x =
      origin_.x + 0.5 * column_.x + (r + 0.5) * row_.x;  // the centre of the row's first cell
  const double first_y = origin_.y + 0.5 * column_.y + (r + 0.5) * row_.y;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::uint8_t index = index_of_cell(cells[i]);
    if (index == 0) continue;
    const auto c = static_cast<double>(column + i);
    const double x = first_x + c * column_.x, y = first_y + c * column_.y;
    if (dabs == 0 || dabs_ + dabs > kMostDabs || !is_near(x, y)) {
      ++left_out_;
      continue;
    }
    dabs_ += dabs;
    if (side_ == 1) {
      draw_dot(x, y, index);
      continue;
    }
    for (int v = 0; v < side_; ++v) {
      for (int u = 0; u < side_; ++u) {
        const double along = c + (u + 0.5) / side_, up = r + (v + 0.5) / side_;
        draw_dot(origin_.x + along * column_.x + up * row_.x, origin_.y + along * column_.y + up * row_.y,
                 index);
      }
    }
  }
}

Sheet::Sheet(const Frame& frame)
    : frame_(frame), places_(static_cast<std::size_t>(frame.tiles) * static_cast<std::size_t>(frame.tiles)) {}

std::uint16_t Sheet::make_part(int x, int y) {
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

namespace {

constexpr int kSmall = kSide / kStep;
using Small = std::array<std::uint8_t, kSmall * kSmall>;  // a tile at the scale of the next coarser level

/// Changed tiles by the coarser tile that contains them.
using Changed = std::map<TileIndex, std::vector<std::pair<TileIndex, Small>>>;

Small shrink(const Pixels& pixels) {
  Small small{};
  for (std::size_t row = 0; row < kSide; ++row) {
    const std::uint8_t* from = pixels.data() + row * kSide;
    std::uint8_t* to = small.data() + row / kStep * kSmall;
    for (std::size_t i = 0; i < kSmall; ++i) {
      const std::uint8_t* four = from + i * kStep;
      to[i] = std::max({to[i], four[0], four[1], four[2], four[3]});
    }
  }
  return small;
}

/// Copies a part to its place in the coarser tile.
void paste(const TileIndex& part, const Small& small, Pixels& pixels) {
  const int x = (part.x & (kStep - 1)) * kSmall, y = (part.y & (kStep - 1)) * kSmall;
  for (int row = 0; row < kSmall; ++row) {  // the part's top row is its last one in y
    std::copy_n(small.data() + static_cast<std::size_t>(row) * kSmall, kSmall,
                pixels.data() + index_of(x, y + kSmall - 1 - row));
  }
}

/// Lays tiles over the canvas, from the base up.
class Layers {
 public:
  Layers(const Canvas& before, Drawing& drawing) : before_(before), drawing_(drawing) {}

  template <class Change>
  void change(const TileIndex& at, Changed& changed, Change change) {
    const auto found = before_.tiles.find(at);
    if (found == before_.tiles.end()) {
      was_.fill(0);
    } else {
      packer_.unpack(*found->second, was_);
    }
    is_ = was_;
    change(is_);
    if (is_ == was_) return;
    drawing_.tiles.emplace_back(at, packer_.pack(is_));
    if (at.level + 1 < kLevels) changed[coarser(at)].emplace_back(at, shrink(is_));
  }

 private:
  const Canvas& before_;
  Drawing& drawing_;
  Packer packer_;
  Pixels was_{}, is_{};
};

/// Unknown cells leave the earlier ones.
void lay_cells(const Pixels& cells, Pixels& over) {
  for (std::size_t i = 0; i < over.size(); ++i) over[i] = cells[i] != 0 ? cells[i] : over[i];
}

void lay_heights(const Pixels& heights, Pixels& over) {
  for (std::size_t i = 0; i < over.size(); ++i) over[i] = std::max(over[i], heights[i]);
}

/// The known part of a tile, in metres. Requires a known pixel.
Area area_of(const Sheet::Part& part) {
  std::array<std::uint8_t, kSide> columns{};
  int top = -1, bottom = 0;  // rows from the top
  for (int row = 0; row < kSide; ++row) {
    const std::uint8_t* from = part.pixels->data() + static_cast<std::size_t>(row) * kSide;
    std::uint8_t any = 0;
    for (std::size_t i = 0; i < kSide; ++i) {
      columns[i] |= from[i];
      any |= from[i];
    }
    if (any == 0) continue;
    if (top < 0) top = row;
    bottom = row + 1;
  }
  icd::require(top >= 0);
  const auto is_known = [](std::uint8_t index) { return index != 0; };
  const auto left = std::ranges::find_if(columns, is_known) - columns.begin();
  const auto right = std::find_if(columns.rbegin(), columns.rend(), is_known).base() - columns.begin();
  const double x = part.at.x * double{kSide}, y = (part.at.y + 1) * double{kSide};
  return {(x + static_cast<double>(left)) * kPixel, (y - bottom) * kPixel,
          (x + static_cast<double>(right)) * kPixel, (y - top) * kPixel};
}

/// Leaves out a hundredth of the pixels at either end, as errors would compress the colours of the others.
std::optional<Heights> heights_of(const Sheet& sheet) {
  std::array<std::size_t, 256> count{};
  for (const auto& part : sheet.parts()) {
    for (const std::uint8_t index : *part.pixels) {
      if (index != 0) ++count[index];  // most are unknown: counting them takes five times as long
    }
  }
  std::size_t known = 0;
  for (std::size_t index = 1; index < count.size(); ++index) known += count[index];
  if (known == 0) return {};
  const auto beyond = [&](std::size_t pixels) {  // the first index up to which there are more pixels
    std::size_t index = 0;
    for (std::size_t below = 0; below <= pixels;) below += count[++index];
    return static_cast<std::uint8_t>(index);
  };
  const std::size_t few = known / 100;
  const auto rounded = [](double metres) {
    return std::round(metres * 10) / 10;  // for the reader
  };
  return Heights{rounded(height_of(beyond(few)) - kHeightStep / 2),
                 rounded(height_of(beyond(known - 1 - few)) + kHeightStep / 2)};
}

/// Lays a map's sheet over `before`, at all levels. Fills in tiles, area and heights. Its layer must be set.
void lay(const Sheet& sheet, const Canvas& before, Drawing& drawing) {
  const bool is_grid = drawing.layer.kind == LayerKind::Grid;
  Layers layers{before, drawing};
  Changed changed;
  for (const Sheet::Part& part : sheet.parts()) {
    extend(drawing.area, area_of(part));
    layers.change(part.at, changed, [&](Pixels& pixels) {
      if (is_grid) return lay_cells(*part.pixels, pixels);
      lay_heights(*part.pixels, pixels);
    });
  }
  while (!changed.empty()) {
    Changed coarser_ones;
    for (const auto& [at, parts] : changed) {
      layers.change(at, coarser_ones, [&parts](Pixels& pixels) {
        for (const auto& [part, small] : parts) paste(part, small, pixels);
      });
    }
    changed = std::move(coarser_ones);
  }
  if (!is_grid) drawing.heights = heights_of(sheet);
}

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
  return AlignedGrid::can_draw(grid, placement) ? draw_by<AlignedGrid>(grid, placement, data, sheet, between)
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

namespace {

/// Cuts a cloud's data into points, piece by piece. Calls `visit(bytes)` with each `stride`th point.
class PointCutter {
 public:
  PointCutter(std::size_t point_step, std::size_t stride) : step_(point_step), stride_(stride) {}

  template <class Visit>
  void feed(std::span<const std::uint8_t> piece, Visit visit) {
    if (!cut_.empty()) {
      const auto more = piece.first(std::min(piece.size(), step_ - cut_.size()));
      cut_.insert(cut_.end(), more.begin(), more.end());
      piece = piece.subspan(more.size());
      if (cut_.size() < step_) return;
      give(cut_.data(), visit);
      cut_.clear();
    }
    for (; piece.size() >= step_; piece = piece.subspan(step_)) give(piece.data(), visit);
    cut_.assign(piece.begin(), piece.end());
  }

 private:
  template <class Visit>
  void give(const std::uint8_t* point, Visit& visit) {
    if (number_ == 0) visit(point);
    if (++number_ == stride_) number_ = 0;
  }

  std::size_t step_, stride_, number_ = 0;
  std::vector<std::uint8_t> cut_;  // the first bytes of a point that continues in the next piece
};

template <class Float, bool Bigendian>
Float coordinate(const std::uint8_t* at) {
  static_assert(std::endian::native == std::endian::little);
  std::array<std::uint8_t, sizeof(Float)> bytes;
  std::memcpy(bytes.data(), at, sizeof(Float));
  if constexpr (Bigendian) std::ranges::reverse(bytes);
  return std::bit_cast<Float>(bytes);
}

/// Draws points as seen from above.
class PointPainter {
 public:
  PointPainter(const icd::PointCloud2& cloud, Sheet& sheet)
      : sheet_(sheet), placement_(cloud.origin.value_or(icd::Pose{})) {}

  void draw_point(const icd::Point& point) {
    const auto [x, y, z] = placement_(point);
    const auto inside = [](double at) { return at >= -kWorldMetres && at < kWorldMetres; };  // false for NaN
    if (!inside(x) || !inside(y) || !std::isfinite(z) || !sheet_.raise(pixel(x), pixel(y), height_index(z))) {
      ++left_out;
    }
  }

  std::size_t left_out = 0;

 private:
  static int pixel(double metres) {
    return static_cast<int>((metres + kWorldMetres) * (1 / kMetresPerPixel[0])) - kWorldPixels;  // floor
  }

  Sheet& sheet_;
  icd::Placement placement_;
};

template <class Float, bool Bigendian>
icd::Checked<std::size_t> draw_points(const icd::PointCloud2& cloud, const icd::MapData& data, Sheet& sheet,
                                      const Between& between) {
  const auto at = icd::axes_of(cloud);
  const std::size_t points = data.raw_size / cloud.point_step;
  PointCutter cutter{cloud.point_step, std::max<std::size_t>(1, (points + kMostPoints - 1) / kMostPoints)};
  PointPainter painter{cloud, sheet};
  ADIT_TRY(codec::for_each_piece(data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
    cutter.feed(piece, [&](const std::uint8_t* point) {
      painter.draw_point({coordinate<Float, Bigendian>(point + at[0]),
                          coordinate<Float, Bigendian>(point + at[1]),
                          coordinate<Float, Bigendian>(point + at[2])});
    });
    between();
    return {};
  }));
  return painter.left_out;
}

}  // namespace

icd::Checked<std::size_t> draw_cloud(const icd::PointCloud2& cloud, const icd::MapData& data, Sheet& sheet,
                                     const Between& between) {
  const bool is_double = icd::field_of(cloud, "x").datatype == icd::Datatype::Float64;
  if (cloud.is_bigendian) {
    return is_double ? draw_points<double, true>(cloud, data, sheet, between)
                     : draw_points<float, true>(cloud, data, sheet, between);
  }
  return is_double ? draw_points<double, false>(cloud, data, sheet, between)
                   : draw_points<float, false>(cloud, data, sheet, between);
}

}  // namespace adit::picture
