#include "rehearsal/robots/maps/ply.hpp"

#include <map>
#include <optional>
#include <vector>

#include "rehearsal/robots/maps/bytes.hpp"
#include "rehearsal/robots/maps/point_table.hpp"

namespace adit::robots {
namespace {

/// PLY's type names, old and new, as the ICD's datatypes; 0 for others.
int datatype_of(std::string_view type) {
  static const std::map<std::string_view, int> kDatatypes = {
      {"char", 1},         {"int8", 1},           {"uchar", 2},         {"uint8", 2},
      {"short", 3},        {"int16", 3},          {"ushort", 4},        {"uint16", 4},
      {"int", 5},          {"int32", 5},          {"uint", 6},          {"uint32", 6},
      {"float", kFloat32}, {"float32", kFloat32}, {"double", kFloat64}, {"float64", kFloat64}};
  const auto found = kDatatypes.find(type);
  return found == kDatatypes.end() ? 0 : found->second;
}

using Words = std::vector<std::string_view>;

struct PlyHeader {
  std::string format;
  std::optional<std::uint64_t> vertices;
  PointTable table;
  std::size_t lines = 1;  // "ply"
  bool in_vertex = false;

  std::expected<void, std::string> element(const Words& words) {
    in_vertex = words.size() == 3 && words[1] == "vertex";
    if (!in_vertex) {
      if (vertices) return {};
      return std::unexpected("expected the first element to be vertex");
    }
    if (vertices) return std::unexpected("element vertex is given twice");
    vertices = parse_number<std::uint32_t>(words[2]);
    if (!vertices)
      return std::unexpected("element vertex: expected a whole number, got '" + std::string(words[2]) + "'");
    return {};
  }

  std::expected<void, std::string> property(const Words& words) {
    if (!in_vertex) return {};
    const int datatype = words.size() == 3 ? datatype_of(words[1]) : 0;
    if (datatype == 0) {
      return std::unexpected("property " + std::string(words.back()) +
                             " of vertex: expected a single value of a known type");
    }
    table.add_field(std::string(words[2]), datatype, 1);
    return {};
  }
};

std::expected<PlyHeader, std::string> take_ply_header(std::string_view& rest) {
  constexpr std::size_t kMostLines = 1000;
  if (take_line(rest).value_or("") != "ply")
    return std::unexpected("not a PLY file: the first line is not 'ply'");
  PlyHeader header;
  while (const auto line = take_line(rest)) {
    if (++header.lines > kMostLines) break;
    const Words words = words_of(*line);
    if (words.empty()) continue;
    std::expected<void, std::string> taken;
    if (words[0] == "end_header") return header;
    if (words[0] == "format" && words.size() >= 2) header.format = words[1];
    if (words[0] == "element") taken = header.element(words);
    if (words[0] == "property") taken = header.property(words);
    if (!taken) return std::unexpected(taken.error());
  }
  return std::unexpected("not a PLY file: the header has no end_header");
}

}  // namespace

std::expected<Cloud, std::string> parse_ply(std::string_view bytes) {
  std::string_view rest = bytes;
  const auto header = take_ply_header(rest);
  if (!header) return std::unexpected(header.error());
  const auto vertices = header->vertices;
  if (!vertices) return std::unexpected("no element vertex");
  if (const auto checked = header->table.check(); !checked) return std::unexpected(checked.error());
  if (header->format == "ascii") return header->table.from_ascii(rest, *vertices, header->lines + 1);
  if (header->format == "binary_little_endian") return header->table.from_binary(rest, *vertices);
  return std::unexpected("format: expected ascii or binary_little_endian, got '" + header->format + "'");
}

}  // namespace adit::robots
