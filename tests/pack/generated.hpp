#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "icd/mapping.hpp"
#include "pack/layouts.hpp"

namespace adit::pack {

inline icd::MapUpdate update_of(icd::PointCloud2 cloud, const Bytes& bytes) {
  return {icd::RobotName::parse("r1"),
          std::move(cloud),
          {icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()}};
}

/// Clouds with random fields, with and without padding. Only coordinates have an order.
class Generator {
 public:
  explicit Generator(std::uint64_t seed) : random_(seed) {}

  std::size_t any(std::size_t low, std::size_t high) {
    return std::uniform_int_distribution<std::size_t>{low, high}(random_);
  }
  double real(double low, double high) { return std::uniform_real_distribution{low, high}(random_); }

  /// x, y and z among other fields, in any order, sometimes with gaps.
  icd::PointCloud2 fields(bool is_bigendian) {
    icd::PointCloud2 cloud;
    cloud.is_bigendian = is_bigendian;
    const auto axes = any(0, 2) == 0 ? icd::Datatype::Float64 : icd::Datatype::Float32;
    for (const char* name : {"x", "y", "z"}) cloud.fields.push_back({name, 0, axes, 1});
    for (std::size_t more = any(0, 3); more > 0; --more) {
      cloud.fields.push_back({"f" + std::to_string(more), 0, static_cast<icd::Datatype>(any(1, 8)),
                              static_cast<std::uint32_t>(any(1, 3))});
    }
    std::ranges::shuffle(cloud.fields, random_);
    const bool has_gaps = any(0, 1) == 1;
    auto places = std::vector<std::size_t>(cloud.fields.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
    std::ranges::shuffle(places, random_);  // the list order may differ from the order in memory
    std::uint32_t end = 0;
    for (const std::size_t place : places) {
      icd::FieldSchema& field = cloud.fields[place];
      if (has_gaps) end += static_cast<std::uint32_t>(any(0, 7));
      field.offset = end;
      end += static_cast<std::uint32_t>(icd::size_of(field.datatype)) * field.count;
    }
    cloud.point_step = end + static_cast<std::uint32_t>(has_gaps ? any(0, 9) : 0);
    return cloud;
  }

  /// `at` returns a point's coordinates. Other fields and padding are random.
  template <class At>
  icd::MapUpdate cloud(icd::PointCloud2 form, std::size_t points, At at) {
    Bytes bytes;
    for (std::size_t i = 0; i < points; ++i) {
      Bytes point(form.point_step);
      for (auto& byte : point) byte = static_cast<std::uint8_t>(any(0, 3) * 80);
      const std::array<double, 3> place = at(i);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto field = std::ranges::find(form.fields, std::string(1, static_cast<char>('x' + axis)),
                                             &icd::FieldSchema::name);
        if (field->datatype == icd::Datatype::Float64) {
          put(point, field->offset, place[axis], form.is_bigendian);
        } else {
          put(point, field->offset, static_cast<float>(place[axis]), form.is_bigendian);
        }
      }
      bytes.insert(bytes.end(), point.begin(), point.end());
    }
    return update_of(std::move(form), bytes);
  }

  /// A point on a tunnel's wall around `middle`.
  std::array<double, 3> on_wall(const std::array<double, 3>& middle, double length) {
    const double along = real(0, length), angle = real(0, 6.28);
    return {middle[0] + along, middle[1] + 3 * std::cos(angle) + real(-0.02, 0.02),
            middle[2] + 2.5 * std::sin(angle) + real(-0.02, 0.02)};
  }

 private:
  std::mt19937_64 random_;
};

/// The recorded clouds in the directory ADIT_MAPS, with x, y, z and intensity; empty if it is not set.
inline std::vector<icd::MapUpdate> recorded_clouds() {
  const char* const named = std::getenv("ADIT_MAPS");
  std::vector<icd::MapUpdate> clouds;
  if (named == nullptr || !std::filesystem::exists(std::filesystem::path(named) / "clouds")) return clouds;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(named) / "clouds")) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string all(std::istreambuf_iterator<char>(file), {});
    const bool is_ply = entry.path().extension() == ".ply";
    const std::string count = is_ply ? "element vertex " : "POINTS ",
                      end = is_ply ? "end_header\n" : "DATA binary\n";
    const std::size_t points = std::stoul(all.substr(all.find(count) + count.size(), 10));
    const std::size_t begin = all.find(end) + end.size();
    icd::PointCloud2 cloud;
    for (const char* name : {"x", "y", "z", "intensity"}) {
      cloud.fields.push_back({name, cloud.point_step, icd::Datatype::Float32, 1});
      cloud.point_step += 4;
    }
    const std::string data = all.substr(begin, points * cloud.point_step);  // one file has further bytes
    const Bytes bytes(data.begin(), data.end());
    clouds.push_back(update_of(std::move(cloud), bytes));
  }
  return clouds;
}

}  // namespace adit::pack
