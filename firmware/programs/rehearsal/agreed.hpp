#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>

// Shared by the two programs, so that the Command Post can tell how much of the robots' posts has come.

namespace adit {

/// The ICD's artifact types (5.2).
inline constexpr auto kArtifactTypes = std::to_array<std::string_view>({
#include "icd/artifact_types.inc"
});

/// Metres, in the "darpa" frame.
struct Vector3 {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Vector3&, const Vector3&) = default;
};

struct Rotation {
  double x = 0, y = 0, z = 0, w = 1;
  friend bool operator==(const Rotation&, const Rotation&) = default;
};

struct Placement {
  Vector3 position;
  Rotation orientation;
  friend bool operator==(const Placement&, const Placement&) = default;
};

inline constexpr std::uint8_t kUnknown = 255;  // a cell (ICD 6.3.1)

/// ICD 6.3.2. `datatype` is the ICD's number: 1 to 8.
struct CloudField {
  std::string name;
  std::uint32_t offset = 0;
  int datatype = 0;
  std::uint32_t count = 1;
  friend bool operator==(const CloudField&, const CloudField&) = default;
};

inline constexpr int kUint32 = 6;
inline constexpr int kFloat32 = 7;
inline constexpr int kFloat64 = 8;

/// Bytes of one value of the ICD's datatype 1 to 8.
inline std::uint32_t size_of_datatype(int datatype) {
  constexpr std::array<std::uint32_t, 9> kBytes = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes.at(static_cast<std::size_t>(datatype));
}

/// By the machine's clock.
using Moment = std::chrono::sys_time<std::chrono::milliseconds>;

/// The bytes that adit-robots repeats between the rows of organised clouds. Read as a point of float32 they
/// are finite and outside each cave, so that the Command Post recognises them.
inline constexpr std::string_view kRowPadding = "PADDINGOFROW";

/// A grid's date: these five cells (13, 87, 42, 61, 99; no values of the cave's), and digits, the highest
/// first, of the milliseconds since 1970 modulo kDateBase ^ kDateDigits (121 days).
inline constexpr std::string_view kDateFollows = "\x0d\x57\x2a\x3d\x63";
inline constexpr std::size_t kDateDigits = 5;
inline constexpr std::int64_t kDateBase = 101;

/// The known cells of grids, each counted once: of grids that a robot posted, or that the Command Post has.
/// Cells of another size are different cells. Both programs use it.
class KnownCells {
 public:
  /// Cells, row by row from the lower left at (`left`, `bottom`), in metres as `resolution`; `width` >= 1.
  void add(double resolution, double left, double bottom, std::size_t width,
           std::span<const std::uint8_t> cells) {
    const std::int64_t size = std::llround(resolution * 1e6);
    const std::int64_t first = std::llround(left / resolution);
    std::int64_t row = std::llround(bottom / resolution);
    for (; !cells.empty(); ++row) {
      const auto columns = cells.first(std::min(width, cells.size()));
      for (std::size_t x = 0; x < columns.size(); ++x) {
        if (columns[x] != kUnknown) include(size, first + static_cast<std::int64_t>(x), row);
      }
      cells = cells.subspan(columns.size());
    }
  }

  std::size_t count() const { return count_; }

 private:
  static constexpr std::int64_t kSide = 64;
  using Place = std::tuple<std::int64_t, std::int64_t, std::int64_t>;  // of a tile: cell size, column, row
  using Tile = std::bitset<kSide * kSide>;

  void include(std::int64_t size, std::int64_t column, std::int64_t row) {
    const Place place{size, column >> 6, row >> 6};
    if (last_ == nullptr || place != last_place_) {
      last_ = &tiles_[place];
      last_place_ = place;
    }
    auto cell = (*last_)[static_cast<std::size_t>((row & (kSide - 1)) * kSide + (column & (kSide - 1)))];
    count_ += cell ? 0 : 1;
    cell = true;
  }

  std::map<Place, Tile> tiles_;
  Place last_place_;
  Tile* last_ = nullptr;  // that of the cell before
  std::size_t count_ = 0;
};

/// The places that clouds have points in, cubes of kEdge, each counted once however many points it has: of
/// what a robot posted, and of what the Command Post has. Both programs of this folder measure by it.
class KnownPlaces {
 public:
  static constexpr double kEdge = 0.1;  // metres
  static constexpr std::size_t kMostBlocks = 1u << 20;

  /// Points of `step` bytes, little-endian, relative to `origin`; `fields` has the places of x, y and z.
  /// Ignores the cloud's orientation, because adit-robots turns no cloud. Ignores points of other types than
  /// float32 (ICD 6.3.2), points farther away than 50 km, and points after kMostBlocks blocks.
  template <class Fields>
  void add(const Fields& fields, std::size_t step, std::span<const std::uint8_t> points,
           const std::array<double, 3>& origin = {}) {
    std::array<std::size_t, 3> offsets{};
    std::size_t axis = 0;
    for (const std::string_view name : {"x", "y", "z"}) {
      const auto field = std::ranges::find_if(fields, [&](const auto& each) { return each.name == name; });
      if (field == fields.end() || field->datatype != kFloat32) return;
      offsets[axis++] = field->offset;
    }
    for (; points.size() >= step; points = points.subspan(step)) include(points, offsets, origin);
  }

  std::size_t count() const { return count_; }

 private:
  static constexpr double kMost = 500'000;  // places to either side
  static constexpr unsigned kBits = 18;     // of the number of a block of 4 x 4 x 4 places, on one axis

  void include(std::span<const std::uint8_t> point, const std::array<std::size_t, 3>& offsets,
               const std::array<double, 3>& origin) {
    std::uint64_t block = 0, within = 0;
    for (std::size_t axis = 0; axis < offsets.size(); ++axis) {
      float metres = 0;
      std::memcpy(&metres, point.data() + offsets[axis], sizeof metres);
      const double at = std::floor((origin[axis] + static_cast<double>(metres)) / kEdge);
      if (!(std::abs(at) < kMost)) return;  // nor NaN
      const auto place = static_cast<std::uint64_t>(std::llround(at + kMost));
      block = block << kBits | place >> 2;
      within = within << 2 | (place & 3);
    }
    if (blocks_.size() >= kMostBlocks && !blocks_.contains(block)) return;
    std::uint64_t& places = blocks_[block];
    const std::uint64_t bit = std::uint64_t{1} << within;
    count_ += (places & bit) == 0 ? 1 : 0;
    places |= bit;
  }

  std::unordered_map<std::uint64_t, std::uint64_t> blocks_;
  std::size_t count_ = 0;
};

}  // namespace adit
