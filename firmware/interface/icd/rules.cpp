#include "icd/rules.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::icd {
namespace {

Checked<void> check_side(const char* path, std::uint32_t cells) {
  if (cells >= 1 && cells <= kMostCellsASide) return {};
  return unprocessable(path, ": expected a whole number from 1 to ", kMostCellsASide, ", got ", cells);
}

/// ICD 6.3.2: a field lies within its point.
Checked<void> check_place(const FieldSchema& field, std::size_t index, std::uint32_t point_step) {
  if (field.count < 1) return unprocessable("msg.fields[", index, "].count: expected at least 1, got 0");
  const std::size_t size = size_of(field.datatype);
  const std::uint64_t end = field.offset + std::uint64_t{size} * field.count;
  if (end <= point_step) return {};
  return unprocessable("msg.fields[", index, "].offset: expected the field to end within point_step ",
                       point_step, ", got ", field.offset, " + ", size, " x ", field.count, " = ", end);
}

Checked<std::size_t> find_unique(const std::vector<FieldSchema>& fields, std::string_view name) {
  const auto count = std::ranges::count(fields, name, &FieldSchema::name);
  if (count == 1) {
    return static_cast<std::size_t>(std::ranges::find(fields, name, &FieldSchema::name) - fields.begin());
  }
  if (count == 0) return unprocessable("msg.fields: missing field ", quote_text(name));
  return unprocessable("msg.fields: expected one field ", quote_text(name), ", got ", count);
}

/// Clouds that crash a server, or that it drops: x, y, z not once each, or not of one float type.
Checked<void> check_coordinates(const std::vector<FieldSchema>& fields) {
  static constexpr std::array<std::string_view, 3> kCoordinates = {"x", "y", "z"};
  Datatype datatype{};
  for (const std::string_view name : kCoordinates) {
    const auto index = ADIT_TRY(find_unique(fields, name));
    const FieldSchema& field = fields[index];
    const auto given = static_cast<int>(field.datatype);
    if (field.datatype != Datatype::Float32 && field.datatype != Datatype::Float64) {
      return unprocessable("msg.fields[", index, "].datatype: expected 7 or 8 for ", quote_text(name),
                           ", got ", given);
    }
    if (name == "x") datatype = field.datatype;
    if (field.datatype != datatype) {
      return unprocessable("msg.fields[", index, "].datatype: expected ", static_cast<int>(datatype),
                           " as for \"x\", got ", given);
    }
    if (field.count != 1) {
      return unprocessable("msg.fields[", index, "].count: expected 1 for ", quote_text(name), ", got ",
                           field.count);
    }
  }
  return {};
}

}  // namespace

Checked<void> check(const OccupancyGrid& grid, const Rules& rules) {
  using Float = std::numeric_limits<float>;                   // as in ROS
  constexpr double kBecomesZero = Float::denorm_min() / 2.0;  // halfway is rounded to even, to 0
  if (!(grid.resolution > kBecomesZero && grid.resolution <= Float::max())) {  // false for NaN
    return unprocessable("msg.info.resolution: expected a finite float32 above 0, got ", grid.resolution);
  }
  if (auto checked = check_side("msg.info.width", grid.width); !checked) return checked;
  if (auto checked = check_side("msg.info.height", grid.height); !checked) return checked;
  const std::uint64_t cells = std::uint64_t{grid.width} * grid.height;
  if (cells <= rules.map_bytes) return {};
  const bool is_curable = cells <= kMostMapBytes;
  const char* const cure = is_curable ? " (the setting rules.map_bytes)" : "";
  return std::unexpected(
      Refusal{.status = Status::ContentTooLarge,
              .sentence = sentence("msg.info.width: expected at most ", rules.map_bytes, " cells", cure,
                                   ", got ", grid.width, " x ", grid.height, " = ", cells),
              .setting = is_curable ? "rules.map_bytes" : ""});
}

Checked<void> check_size(const OccupancyGrid& grid, std::size_t bytes) {
  require(grid.width > 0 && grid.height > 0);
  const std::size_t cells = cells_of(grid);
  if (bytes == cells) return {};
  return unprocessable("msg.info.width: expected ", grid.width, " x ", grid.height, " = ", cells,
                       " bytes of data, got ", bytes);
}

Checked<void> check(const PointCloud2& cloud, const Rules& /*rules*/) {
  if (cloud.point_step < 1 || cloud.point_step > kLargestPoint) {
    return unprocessable("msg.point_step: expected a whole number from 1 to ", kLargestPoint, ", got ",
                         cloud.point_step);
  }
  if (cloud.fields.empty())
    return unprocessable("msg.fields: expected at least x, y and z, got an empty list");
  if (cloud.fields.size() > kMostFields) {
    return unprocessable("msg.fields: expected at most ", kMostFields, " fields, got ", cloud.fields.size());
  }
  for (std::size_t i = 0; i < cloud.fields.size(); ++i) {
    if (auto checked = check_place(cloud.fields[i], i, cloud.point_step); !checked) return checked;
  }
  return check_coordinates(cloud.fields);
}

Checked<void> check_size(const PointCloud2& cloud, std::size_t bytes) {
  require(cloud.point_step > 0);
  if (bytes % cloud.point_step == 0) return {};
  return unprocessable("msg.data: expected a multiple of point_step ", cloud.point_step, ", got ", bytes,
                       " bytes");
}

Checked<void> check_frame_id(std::string_view frame_id, std::string_view path, const Rules& rules) {
  if (frame_id == kFrame || rules.rewrite_frame_id) return {};
  return unprocessable_by_setting("rules.rewrite_frame_id", path, ": expected \"", kFrame, "\", got ",
                                  quote_text(frame_id),
                                  " (the setting rules.rewrite_frame_id accepts any frame)");
}

}  // namespace adit::icd
