#include "rehearsal/robots/maps/pcd.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "rehearsal/robots/maps/bytes.hpp"
#include "rehearsal/robots/maps/point_table.hpp"

namespace adit::robots {
namespace {

struct PcdHeader {
  std::map<std::string_view, std::vector<std::string_view>> entries;
  std::size_t lines = 0;

  std::vector<std::string_view> find(std::string_view name) const {
    const auto found = entries.find(name);
    return found == entries.end() ? std::vector<std::string_view>{} : found->second;
  }
};

std::expected<PcdHeader, std::string> take_pcd_header(std::string_view& rest) {
  constexpr std::size_t kMostLines = 100;  // a PCD's header has 11
  PcdHeader header;
  while (const auto line = take_line(rest)) {
    if (++header.lines > kMostLines) break;
    auto words = words_of(*line);
    if (words.empty() || words[0].starts_with('#')) continue;
    const std::string_view name = words[0];
    words.erase(words.begin());
    header.entries[name] = std::move(words);
    if (name == "DATA") return header;
  }
  return std::unexpected("not a PCD file: the header has no DATA line");
}

/// PCD's type letter and size as the ICD's datatype, or 0.
int datatype_of(std::string_view type, std::string_view size) {
  static const std::map<std::string, int> kDatatypes = {
      {"I1", 1}, {"U1", 2}, {"I2", 3}, {"U2", 4}, {"I4", 5}, {"U4", 6}, {"F4", kFloat32}, {"F8", kFloat64}};
  const auto found = kDatatypes.find(std::string(type) + std::string(size));
  return found == kDatatypes.end() ? 0 : found->second;
}

std::expected<PointTable, std::string> table_of(const PcdHeader& header) {
  constexpr std::uint32_t kMostValues = 4096;
  constexpr std::size_t kMostFields = 256;
  const auto fields = header.find("FIELDS"), sizes = header.find("SIZE"), types = header.find("TYPE");
  auto counts = header.find("COUNT");
  if (counts.empty()) counts.assign(fields.size(), "1");
  if (fields.empty() || sizes.size() != fields.size() || types.size() != fields.size() ||
      counts.size() != fields.size()) {
    return std::unexpected("FIELDS, SIZE, TYPE and COUNT: expected as many entries in each");
  }
  if (fields.size() > kMostFields) return std::unexpected("FIELDS: expected at most 256");
  PointTable table;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string name(fields[i]);
    const int datatype = datatype_of(types[i], sizes[i]);
    if (datatype == 0) {
      return std::unexpected("field '" + name + "': a point cloud message has no type for TYPE " +
                             std::string(types[i]) + " of SIZE " + std::string(sizes[i]));
    }
    const auto count = parse_number<std::uint32_t>(counts[i]);
    if (!count || *count < 1 || *count > kMostValues) {
      return std::unexpected("field '" + name + "': expected a COUNT from 1 to 4096, got '" +
                             std::string(counts[i]) + "'");
    }
    table.add_field(name, datatype, *count);
  }
  if (auto checked = table.check(); !checked) return std::unexpected(checked.error());
  return table;
}

std::expected<std::uint64_t, std::string> points_of(const PcdHeader& header) {
  const auto number = [&](std::string_view name) -> std::optional<std::uint32_t> {
    const auto words = header.find(name);
    return words.size() == 1 ? parse_number<std::uint32_t>(words[0]) : std::nullopt;
  };
  if (const auto points = number("POINTS")) return *points;
  const auto width = number("WIDTH"), height = number("HEIGHT");
  if (header.find("POINTS").empty() && width && height) return std::uint64_t{*width} * *height;
  return std::unexpected("POINTS: expected a whole number");
}

/// VIEWPOINT: tx ty tz qw qx qy qz.
std::expected<std::optional<Placement>, std::string> viewpoint_of(const PcdHeader& header) {
  const auto words = header.find("VIEWPOINT");
  if (words.empty()) return std::nullopt;
  std::vector<double> v;
  for (const std::string_view word : words) {
    if (const auto value = parse_number<double>(word); value && std::isfinite(*value)) v.push_back(*value);
  }
  if (v.size() != 7 || words.size() != 7) return std::unexpected("VIEWPOINT: expected 7 numbers");
  Placement placement{.position = {v[0], v[1], v[2]}, .orientation = {v[4], v[5], v[6], v[3]}};
  if (placement.orientation == Rotation{0, 0, 0, 0}) placement.orientation = {};
  if (placement == Placement{}) return std::nullopt;
  return placement;
}

}  // namespace

std::expected<Cloud, std::string> parse_pcd(std::string_view bytes) {
  std::string_view rest = bytes;
  const auto header = take_pcd_header(rest);
  if (!header) return std::unexpected(header.error());
  const auto table = table_of(*header);
  if (!table) return std::unexpected(table.error());
  const auto points = points_of(*header);
  if (!points) return std::unexpected(points.error());
  const auto origin = viewpoint_of(*header);
  if (!origin) return std::unexpected(origin.error());

  const auto data = header->find("DATA");
  const std::string_view form = data.empty() ? "" : data[0];
  if (form != "ascii" && form != "binary") {
    return std::unexpected(
        "DATA: expected ascii or binary, got '" + std::string(form) +
        (form == "binary_compressed" ? "': convert it with pcl_convert_pcd_ascii_binary" : "'"));
  }
  auto cloud = form == "ascii" ? table->from_ascii(rest, *points, header->lines + 1)
                               : table->from_binary(rest, *points);
  if (cloud) cloud->origin = *origin;
  return cloud;
}

}  // namespace adit::robots
