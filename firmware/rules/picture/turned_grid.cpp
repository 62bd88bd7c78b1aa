#include "picture/turned_grid.hpp"

#include <cmath>
#include <numbers>

#include "picture/draw.hpp"
#include "picture/grid_cells.hpp"

namespace adit::picture {
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
