#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <unordered_map>

namespace adit {

/// The places that clouds have points in, cubes of kEdge, each counted once however many points it has: of
/// what a robot posted, and of what the Command Post has. Both programs of this folder measure by it.
class KnownPlaces {
 public:
  static constexpr double kEdge = 0.1;  // metres
  static constexpr std::size_t kMostBlocks = 1u << 20;

  /// Points of `step` bytes, little-endian, which are away from `origin`; `fields` tell where x, y and z are.
  /// How a cloud is turned is not looked at, for adit-robots turns none. Others than float32
  /// (ICD 6.3.2) are passed over, and so is what is further away than 50 km or comes after kMostBlocks
  /// blocks.
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
  static constexpr int kFloat32 = 7;
  static constexpr double kMost = 500'000;  // places to either side
  static constexpr unsigned kBits = 18;     // of the number of a block of 4 x 4 x 4 places, on one axis

  void include(std::span<const std::uint8_t> point, const std::array<std::size_t, 3>& offsets,
               const std::array<double, 3>& origin) {
    std::uint64_t block = 0, within = 0;
    for (std::size_t axis = 0; axis < offsets.size(); ++axis) {
      float metres = 0;
      std::memcpy(&metres, point.data() + offsets[axis], sizeof metres);
      const double at = std::floor((origin[axis] + static_cast<double>(metres)) / kEdge);
      if (!(std::abs(at) < kMost)) return;  // nor what is not a number
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
