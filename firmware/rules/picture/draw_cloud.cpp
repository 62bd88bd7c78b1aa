#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "codec/map_pieces.hpp"
#include "icd/geometry.hpp"
#include "icd/mapping.hpp"
#include "icd/try.hpp"
#include "picture/draw.hpp"
#include "picture/palette.hpp"

namespace adit::picture {
namespace {

/// Cuts a cloud's data into points, piece by piece. Calls `visit(bytes)` with the first of every `stride`
/// points.
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

/// Reads one coordinate of a point.
template <class Float, bool Bigendian>
Float coordinate(const std::uint8_t* at) {
  static_assert(std::endian::native == std::endian::little);
  std::array<std::uint8_t, sizeof(Float)> bytes;
  std::memcpy(bytes.data(), at, sizeof(Float));
  if constexpr (Bigendian) std::ranges::reverse(bytes);
  return std::bit_cast<Float>(bytes);
}

/// Draws points as seen from above.
class Dabber {
 public:
  Dabber(const icd::PointCloud2& cloud, Sheet& sheet)
      : sheet_(sheet), placement_(cloud.origin.value_or(icd::Pose{})) {}

  void dab(const icd::Point& point) {
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
  Dabber dabber{cloud, sheet};
  ADIT_TRY(codec::for_each_piece(data, [&](std::span<const std::uint8_t> piece) -> icd::Checked<void> {
    cutter.feed(piece, [&](const std::uint8_t* point) {
      dabber.dab({coordinate<Float, Bigendian>(point + at[0]), coordinate<Float, Bigendian>(point + at[1]),
                  coordinate<Float, Bigendian>(point + at[2])});
    });
    between();
    return {};
  }));
  return dabber.left_out;
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
