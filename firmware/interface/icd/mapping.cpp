#include "icd/mapping.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "icd/members.hpp"
#include "icd/require.hpp"

namespace adit::icd {

std::size_t size_of(Datatype datatype) {
  constexpr std::array<std::size_t, 9> kBytes = {0, 1, 1, 2, 2, 4, 4, 4, 8};  // by the ICD's number
  const std::size_t number = std::to_underlying(datatype);
  return number < kBytes.size() ? kBytes[number] : 0;
}

const FieldSchema& field_of(const PointCloud2& cloud, std::string_view name) {
  const auto field = std::ranges::find(cloud.fields, name, &FieldSchema::name);
  require(field != cloud.fields.end());
  return *field;
}

std::array<std::size_t, 3> axes_of(const PointCloud2& cloud) {
  return {field_of(cloud, "x").offset, field_of(cloud, "y").offset, field_of(cloud, "z").offset};
}

const Header& MapUpdate::header() const {
  if (const auto* grid = std::get_if<OccupancyGrid>(&msg)) return grid->header;
  return std::get<PointCloud2>(msg).header;
}

Header& MapUpdate::header() {
  if (auto* grid = std::get_if<OccupancyGrid>(&msg)) return grid->header;
  return std::get<PointCloud2>(msg).header;
}

bool is_invisible(const Marker& marker) {
  const bool has_own_colors = !marker.colors.empty() || marker.mesh_use_embedded_materials;
  return marker.action == MarkerAction::Add && marker.color.a == 0 && !has_own_colors;
}

std::size_t bytes_of(const Marker& marker) {
  static_assert(count_of_members<Marker>() == 16, "count the bytes of each text and list");
  constexpr std::size_t kFixed = 640;  // members of fixed size, with the overhead of maps and allocators
  constexpr std::size_t kPoint = 34;   // three named 64-bit numbers of CBOR; in memory 24
  constexpr std::size_t kColor = 45;   // four of them; in memory 32
  return kFixed + 2 * marker.ns.size() + marker.text.size() + marker.mesh_resource.size() +
         kPoint * marker.points.size() + kColor * marker.colors.size();
}

}  // namespace adit::icd
