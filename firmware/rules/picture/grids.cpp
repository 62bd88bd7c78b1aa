#include "picture/grids.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "icd/require.hpp"
#include "picture/draw.hpp"

namespace adit::picture {
namespace {

/// The far end of a row or column may lie this far off its axis, in metres.
constexpr double kMostSkew = kPixel / 10;
/// In cells: a larger distance than the rounding errors of a pixel's border. A cell whose centre lies on a
/// border belongs to the next pixel. Without this, a grid that grows would flicker.
constexpr double kRounding = 1e-3;

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

bool AlignedGrid::suits(const icd::OccupancyGrid& grid, const icd::Placement& placement) {
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
  icd::require(suits(grid, placement));
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
  if (end >= columns_.end()) row_ended(row);
}

void AlignedGrid::row_ended(std::size_t row) {
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

namespace {

/// A lattice with this spacing, in pixels, has a point in every pixel at any angle.
constexpr double kGapless = 1 / std::numbers::sqrt2;

}  // namespace

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

void TurnedGrid::dab(double x, double y, std::uint8_t index) {
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
      dab(x, y, index);
      continue;
    }
    for (int v = 0; v < side_; ++v) {
      for (int u = 0; u < side_; ++u) {
        const double along = c + (u + 0.5) / side_, up = r + (v + 0.5) / side_;
        dab(origin_.x + along * column_.x + up * row_.x, origin_.y + along * column_.y + up * row_.y, index);
      }
    }
  }
}

}  // namespace adit::picture
