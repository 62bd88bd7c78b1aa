// Clouds as robots and surveys make them, in a cave of which only the walls are seen.
#include <array>
#include <cmath>
#include <utility>

#include "pack/generated.hpp"
#include "sizes_maps.hpp"

namespace adit::bench {
namespace {

/// A robot goes along, and sees walls around it.
struct Walls {
  const char* name;
  std::size_t points;
  double step = 0;               // metres to which coordinates were measured; 0: noise
  std::uint32_t point_step = 0;  // 0: no padding
  bool has_color = false;
  icd::Datatype datatype = icd::Datatype::Float32;
  bool is_long = false;
};

constexpr Walls kClouds[] = {
    {.name = "noisy walls, xyz", .points = 300'000},
    {.name = "noisy walls, xyz", .points = 1'500'000, .is_long = true},
    {.name = "noisy walls, xyz in float64", .points = 200'000, .datatype = icd::Datatype::Float64},
    {.name = "noisy walls, xyz and color, padded to 32 bytes",
     .points = 300'000,
     .point_step = 32,
     .has_color = true},
    {.name = "survey in steps of 1 mm, xyz and color", .points = 300'000, .step = 0.001, .has_color = true},
    {.name = "survey in steps of 1 cm, xyz", .points = 300'000, .step = 0.01},
    {.name = "centres of voxels of 5 cm, xyz", .points = 200'000, .step = 0.05},
    {.name = "news of a second, xyz", .points = 5'000},
};

icd::PointCloud2 fields_of(const Walls& walls) {
  icd::PointCloud2 cloud;
  const auto size = static_cast<std::uint32_t>(icd::size_of(walls.datatype));
  for (const char* name : {"x", "y", "z"}) {
    cloud.fields.push_back({name, cloud.point_step, walls.datatype, 1});
    cloud.point_step += size;
  }
  if (walls.has_color) {
    cloud.fields.push_back({"rgb", cloud.point_step, icd::Datatype::Uint32, 1});
    cloud.point_step += 4;
  }
  if (walls.point_step > 0) cloud.point_step = walls.point_step;
  return cloud;
}

template <class Float>
void put_all(std::uint8_t* point, const std::array<double, 3>& at) {
  for (std::size_t axis = 0; axis < at.size(); ++axis) {
    const auto value = static_cast<Float>(at[axis]);
    std::memcpy(point + axis * sizeof value, &value, sizeof value);
  }
}

icd::MapUpdate cloud_of(const Walls& walls, std::uint64_t seed) {
  constexpr double kSeen = 10, kMetresAPoint = 3e-4;
  pack::Generator make{seed + walls.points};
  icd::PointCloud2 cloud = fields_of(walls);
  pack::Bytes bytes(walls.points * cloud.point_step);
  for (std::size_t i = 0; i < walls.points; ++i) {
    auto at = make.on_wall({static_cast<double>(i) * kMetresAPoint, 0, 0}, kSeen);
    if (walls.step > 0) {
      for (double& metres : at) metres = std::round(metres / walls.step) * walls.step;
    }
    std::uint8_t* const point = bytes.data() + i * cloud.point_step;
    if (walls.datatype == icd::Datatype::Float64) put_all<double>(point, at);
    if (walls.datatype == icd::Datatype::Float32) put_all<float>(point, at);
    const auto color = static_cast<std::uint32_t>(120 + make.any(0, 12)) * 0x010101U;
    if (walls.has_color) std::memcpy(point + cloud.fields.back().offset, &color, sizeof color);
  }
  return pack::update_of(std::move(cloud), bytes);
}

}  // namespace

std::vector<SizedMap> generated_clouds(bool is_short, std::uint64_t seed) {
  std::vector<SizedMap> maps;
  for (const Walls& walls : kClouds) {
    if (is_short && walls.is_long) continue;
    maps.push_back({walls.name + (", " + std::to_string(walls.points)) + " points", cloud_of(walls, seed)});
  }
  return maps;
}

}  // namespace adit::bench
