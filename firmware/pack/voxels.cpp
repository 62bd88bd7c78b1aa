#include "pack/voxels.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

namespace adit::pack {
namespace {

constexpr unsigned kBitsInBlock = 2;                        // of an index: which voxel of its block
constexpr unsigned kBitsOfBlock = 21 - kBitsInBlock;        // which block
constexpr std::uint64_t kIsThere = std::uint64_t{1} << 63;  // of the place of a block

template <class Float, class Bits>
double read(const std::uint8_t* at, bool is_bigendian) {
  static_assert(std::endian::native == std::endian::little);
  Bits bits = 0;
  std::memcpy(&bits, at, sizeof bits);
  return std::bit_cast<Float>(is_bigendian ? std::byteswap(bits) : bits);
}

}  // namespace

Voxels::Voxels(const icd::PointCloud2& cloud, double edge)
    : is_bigendian_(cloud.is_bigendian), per_metre_(1 / edge) {
  std::size_t axis = 0;
  for (const std::string_view name : {"x", "y", "z"}) {
    const auto field = std::ranges::find(cloud.fields, name, &icd::FieldSchema::name);
    is_double_ = field->datatype == icd::Datatype::Float64;  // all three are
    offsets_[axis++] = field->offset;
  }
  if (cloud.origin && *cloud.origin != icd::Pose{}) placement_.emplace(*cloud.origin);
}

double Voxels::coordinate(std::span<const std::uint8_t> point, std::size_t axis) const {
  const std::uint8_t* const at = point.data() + offsets_[axis];
  return is_double_ ? read<double, std::uint64_t>(at, is_bigendian_)
                    : read<float, std::uint32_t>(at, is_bigendian_);
}

/// Indexes count from the lowest that is in reach, so that cutting off what is behind the point rounds down.
VoxelBlock Voxels::of(std::span<const std::uint8_t> point) const {
  icd::Point at{coordinate(point, 0), coordinate(point, 1), coordinate(point, 2)};
  if (placement_) at = (*placement_)(at);
  VoxelBlock found{kIsThere, 0};
  unsigned within = 0;
  for (const double metres : {at.x, at.y, at.z}) {
    const double index = metres * per_metre_ + kReach;
    if (!(index >= 0 && index < 2.0 * kReach)) return {};  // nor what is not a number
    const auto whole = static_cast<std::uint32_t>(index);
    found.place = found.place << kBitsOfBlock | whole >> kBitsInBlock;
    within = within << kBitsInBlock | (whole & ((1u << kBitsInBlock) - 1));
  }
  found.place |= kIsThere;
  found.voxels = std::uint64_t{1} << within;
  return found;
}

}  // namespace adit::pack
