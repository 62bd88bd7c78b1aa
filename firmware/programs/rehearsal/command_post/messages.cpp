#include "rehearsal/command_post/messages.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string_view>
#include <utility>

#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "rehearsal/agreed.hpp"
#include "rehearsal/command_post/endpoint.hpp"

namespace adit::rehearsal {

namespace {

using icd::sentence;

/// ICD 6.3.1, `info` and the header of msg.
std::optional<Grid> read_grid(const Field& msg) {
  const auto info = msg.member("info");
  if (!info) return std::nullopt;
  const auto metres = info->number("resolution");
  const auto columns = info->integer("width", 1, UINT32_MAX);
  const auto rows = info->integer("height", 1, UINT32_MAX);
  const auto pose = info->member("origin").and_then(read_pose);
  if (!metres || !columns || !rows || !pose) return std::nullopt;
  if (*metres <= 0) info->member("resolution")->add_violation("expected more than 0", Measured::Takes);
  return Grid{*metres, static_cast<std::uint32_t>(*columns), static_cast<std::uint32_t>(*rows), *pose};
}

std::optional<CloudField> read_cloud_field(const Field& field) {
  const auto name = field.text("name");
  const auto offset = field.integer("offset", 0, UINT32_MAX);
  const auto datatype = field.integer("datatype", 1, kFloat64);
  const auto count = field.integer("count", 1, UINT32_MAX);
  if (!name || !offset || !datatype || !count) return std::nullopt;
  return CloudField{*name, static_cast<std::uint32_t>(*offset), static_cast<int>(*datatype),
                    static_cast<std::uint32_t>(*count)};
}

/// A field that ends past the point kills the measured server. The rehearsal goes on.
bool check_ends(const Cloud& cloud, const Field& fields) {
  for (std::size_t i = 0; i < cloud.fields.size(); ++i) {
    const CloudField& field = cloud.fields[i];
    const std::uint64_t end = field.offset + std::uint64_t{field.count} * size_of_datatype(field.datatype);
    if (end <= cloud.point_step) continue;
    fields.findings().add_violation(
        sentence(fields.path(), "[", i, "]: ends at byte ", end, " of a point of ", cloud.point_step));
    return false;
  }
  return true;
}

/// x, y and z, each there once, all float32 or all float64.
bool check_axes(const Cloud& cloud, const Field& fields) {
  int common = 0;
  for (const char* const axis : {"x", "y", "z"}) {
    const auto named = [axis](const CloudField& field) { return field.name == axis; };
    const auto found = std::ranges::find_if(cloud.fields, named);
    if (found == cloud.fields.end()) {
      fields.add_violation("expected x, y and z, found no " + std::string(axis));
      return false;
    }
    if (std::ranges::count_if(cloud.fields, named) > 1) {
      fields.add_violation("more than one field " + std::string(axis), Measured::Takes);
    }
    if (found->count != 1) fields.add_violation("expected count 1 of " + std::string(axis), Measured::Takes);
    if ((found->datatype != kFloat32 && found->datatype != kFloat64) ||
        (common != 0 && found->datatype != common)) {
      fields.add_violation("expected x, y and z all of datatype 7 or all of 8");
      return false;
    }
    common = found->datatype;
  }
  return true;
}

/// ICD 6.3.2, all but the data.
std::optional<Cloud> read_cloud(const Field& msg) {
  Cloud cloud;
  if (const auto origin = msg.optional_member("origin")) {
    cloud.origin = read_pose(*origin);
    if (!cloud.origin) return std::nullopt;
  }
  if (const auto bigendian = msg.optional_member("is_bigendian")) {
    const auto truth = bigendian->boolean();
    if (!truth) return std::nullopt;
    cloud.is_bigendian = *truth;
  }
  const auto step = msg.member("point_step"), fields = msg.member("fields");
  if (!step || !fields) return std::nullopt;
  const auto bytes = step->integer(0, UINT32_MAX);
  const auto elements = fields->elements();
  if (!bytes || !elements) return std::nullopt;
  for (const Field& element : *elements) {
    auto field = read_cloud_field(element);
    if (!field) return std::nullopt;
    cloud.fields.push_back(std::move(*field));
  }
  if (*bytes == 0) return step->add_violation("expected at least 1, got 0", Measured::Dies);
  cloud.point_step = static_cast<std::uint32_t>(*bytes);
  if (!check_ends(cloud, *fields) || !check_axes(cloud, *fields)) return std::nullopt;
  return cloud;
}

/// The ICD has no rows (6.3.2): a Command Post reads what stands between them as points.
void check_rows(const Field& msg, const Cloud& cloud) {
  const auto width = msg.optional_member("width"), row_step = msg.optional_member("row_step");
  if (!width || !row_step || !width->value().is_number_integer()) return;
  const auto expected = width->value().get<std::uint64_t>() * cloud.point_step;
  if (row_step->value() == Json(expected)) return;
  row_step->add_violation(
      sentence("expected width * point_step = ", expected, ", got ", line_of(row_step->value())),
      Measured::Takes);
}

double coordinate(const char* bytes, std::size_t size, bool bigendian) {
  std::array<char, sizeof(double)> value{};
  std::copy_n(bytes, size, value.begin());
  if (bigendian) std::reverse(value.begin(), value.begin() + static_cast<std::ptrdiff_t>(size));
  if (size == sizeof(double)) return std::bit_cast<double>(value);
  float single = 0;
  std::memcpy(&single, value.data(), sizeof single);
  return single;
}

/// ICD 6.3.2: clouds are dense.
void check_points(const Cloud& cloud, const std::string& data, const Field& msg) {
  if (data.contains(kRowPadding)) {
    msg.findings().add_violation("msg.data: the padding between a robot's rows arrived as points",
                                 Measured::Takes);
  }
  for (std::size_t at = 0; at + cloud.point_step <= data.size(); at += cloud.point_step) {
    for (const CloudField& field : cloud.fields) {
      if (field.name != "x" && field.name != "y" && field.name != "z") continue;
      const std::size_t size = size_of_datatype(field.datatype);
      if (std::isfinite(coordinate(data.data() + at + field.offset, size, cloud.is_bigendian))) continue;
      return msg.findings().add_violation(
          sentence("msg.data: point ", at / cloud.point_step, " has no finite ", field.name, " (ICD 6.3.2)"),
          Measured::Takes);
    }
  }
}

/// ICD 6.3 (a) and (b): base64 in JSON, a byte string in CBOR.
std::optional<std::string> read_bytes(const Field& data, Format format) {
  if (format == Format::CborBytes) {
    if (!data.value().is_binary()) return data.add_violation("expected a byte string (ICD 6.3 b)");
    const auto& binary = data.value().get_binary();
    return std::string(binary.begin(), binary.end());
  }
  if (!data.value().is_string()) return data.add_violation("expected a base64 string (ICD 6.3 a)");
  auto bytes = base64_decoded(data.value().get_ref<const std::string&>());
  if (!bytes) return data.add_violation("expected padded base64 (RFC 4648) without white space");
  return bytes;
}

std::optional<std::string> inflate_data(const Field& data, std::string_view bytes, std::size_t most) {
  auto whole = gunzip(bytes, most);
  if (whole) return std::move(*whole);
  if (whole.error() == InflateFault::TooLarge)
    return data.add_violation(sentence("inflates to more than ", most, " bytes"));
  if (whole.error() == InflateFault::Followed)
    return data.add_violation("bytes after the end of the one gzip member", Measured::Hangs);
  return data.add_violation("expected a complete gzip member (RFC 1952)");
}

/// `data` and `compression`; `most`: how many bytes it may inflate to.
std::optional<std::string> read_data(const Field& msg, Format format, std::size_t most) {
  std::string compression = "none";
  if (const auto field = msg.optional_member("compression")) {
    const auto text = field->to_text();
    if (!text) return std::nullopt;
    if (*text != "none" && *text != "gzip")
      return field->add_violation("expected \"none\" or \"gzip\" (ICD 6.3)");
    compression = *text;
  }
  const auto data = msg.member("data");
  auto bytes = data ? read_bytes(*data, format) : std::nullopt;
  if (!bytes || compression == "none") return bytes;
  return inflate_data(*data, *bytes, most);
}

/// ICD 6.3.1: one byte for each cell, each 0 to 100 or 255.
bool check_cells(const Grid& grid, const std::string& cells, const Field& msg) {
  const std::uint64_t expected = std::uint64_t{grid.width} * grid.height;
  if (cells.size() != expected) {
    msg.findings().add_violation(sentence("msg.data: expected ", grid.width, " x ", grid.height, " = ",
                                          expected, " bytes, got ", cells.size()));
    return false;
  }
  const auto wrong = std::ranges::find_if(cells, [](char c) {
    const auto cell = static_cast<unsigned char>(c);
    return cell > 100 && cell < 255;
  });
  if (wrong != cells.end()) {
    msg.findings().add_violation(
        sentence("msg.data[", wrong - cells.begin(), "]: expected 0 to 100 or 255, got ",
                 static_cast<unsigned char>(*wrong)),
        Measured::Takes);
  }
  return true;
}

std::optional<std::string> read_name(const Field& body) {
  const auto name = body.optional_member("name");
  if (!name) {
    body.findings().add_measured_refusal("Missing field 'name'");
    return "";
  }
  auto text = name->to_text();
  if (text && !text->empty() && !is_robot_name(*text)) {
    name->add_violation("expected 1 to 10 letters, digits and underscores (ICD 2)", Measured::Takes);
  }
  return text;
}

std::optional<MapMessage> read_grid_message(const Field& msg, Format format, MapMessage message) {
  const auto grid = read_grid(msg);
  if (!grid) return std::nullopt;
  const std::uint64_t cells = std::uint64_t{grid->width} * grid->height;
  if (cells > kMostMapBytes) {
    msg.findings().add_violation(sentence("msg.info: more than ", kMostMapBytes, " cells"));
    return std::nullopt;
  }
  auto data = read_data(msg, format, cells);
  if (!data || !check_cells(*grid, *data, msg)) return std::nullopt;
  message.msg = *grid;
  message.data = std::move(*data);
  return message;
}

std::optional<MapMessage> read_cloud_message(const Field& msg, Format format, MapMessage message) {
  auto cloud = read_cloud(msg);
  if (!cloud) return std::nullopt;
  auto data = read_data(msg, format, kMostMapBytes);
  if (!data) return std::nullopt;
  if (data->size() % cloud->point_step != 0) {
    msg.findings().add_violation(
        sentence("msg.data: ", data->size(), " bytes are not a multiple of point_step ", cloud->point_step),
        Measured::Takes);
  }
  check_rows(msg, *cloud);
  check_points(*cloud, *data, msg);
  message.msg = std::move(*cloud);
  message.data = std::move(*data);
  return message;
}

/// zlib's counter is 32 bits wide; no map's data is larger (kMostMapBytes).
unsigned long crc_of(const std::string& data) {
  return crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
}

/// Puts what `data` is in the place of what it holds.
void describe_data(Json& document, const std::optional<MapMessage>& map) {
  if (!document.is_object() || !document.contains("msg")) return;
  Json& msg = document["msg"];
  if (!msg.is_object() || !msg.contains("data")) return;
  Json& data = msg["data"];
  data = map ? Json{{"bytes", map->data.size()}, {"crc32", crc_of(map->data)}}
             : Json{{"unread", data.type_name()}};
}

std::optional<MappingMessage> read_named_map(Json& document, Format format, Findings& findings) {
  auto map = read_map(document, format, findings);
  describe_data(document, map);
  if (!map) return std::nullopt;
  MappingMessage message{.stamps = map->stamps};
  message.parts.push_back({std::holds_alternative<Grid>(map->msg) ? "grid" : "cloud", map->name});
  message.map = std::move(map);
  return message;
}

// Of visualization_msgs/Marker.
constexpr std::int64_t kLineStrip = 4, kLineList = 5, kPoints = 8, kText = 9, kTriangleList = 11,
                       kLastType = kTriangleList;

bool read_color(const Field& color) {
  for (const char* const name : {"r", "g", "b", "a"}) {
    const auto value = color.number(name);
    if (!value) return false;
    if (*value < 0 || *value > 1)
      color.member(name)->add_violation("expected 0 to 1 (ICD 6.6)", Measured::Takes);
  }
  return true;
}

/// A duration is a number of seconds or, as ROS writes it, {secs, nsecs}. The measured server reads neither.
void check_lifetime(const Field& lifetime) {
  const Json& value = lifetime.value();
  if (value.is_object()) {
    for (const char* const name : {"secs", "nsecs"}) {
      const auto part = lifetime.optional_member(name);
      if (!part || !part->value().is_number_integer() || part->value().get<double>() < 0) {
        lifetime.add_violation("expected integers secs and nsecs", Measured::Takes);
        return;
      }
    }
  } else if (!value.is_number() || !(value.get<double>() >= 0)) {
    lifetime.add_violation("expected seconds from 0", Measured::Takes);
  }
}

/// ns and id, optional by the ICD; the measured server wants both.
std::optional<MarkerChange> read_identity(const Field& marker) {
  const auto ns = marker.optional_member("ns");
  const auto id = marker.optional_member("id");
  if (!ns) marker.findings().add_measured_refusal("Missing field '" + marker.path() + ".ns'");
  if (!id) marker.findings().add_measured_refusal("Missing field '" + marker.path() + ".id'");
  const auto number = id ? id->integer(INT32_MIN, INT32_MAX) : 0;
  const auto text = ns ? ns->to_text() : std::string();
  if (!number || !text) return std::nullopt;
  return MarkerChange{.ns = *text, .id = *number};
}

/// ROS's Marker has none, or one for each point if its type has points. rviz also accepts one per triangle.
void check_colors(const Field& colors, std::size_t points, std::int64_t type) {
  const auto elements = colors.elements();
  if (!elements) return;
  for (const Field& color : *elements) {
    if (!read_color(color)) return;
  }
  const bool has_use = (type >= kLineStrip && type <= kPoints) || type == kTriangleList;
  const bool for_triangles = type == kTriangleList && elements->size() == points / 3;
  if (has_use && !elements->empty() && elements->size() != points && !for_triangles) {
    colors.add_violation("expected none or one for each point", Measured::Takes);
  }
}

/// What the ICD means by "further documented in the ROS MarkerArray message documentation": the rest of
/// visualization_msgs/Marker. The measured server publishes it.
void check_geometry(const Field& marker, std::int64_t type) {
  std::size_t count = 0;
  if (const auto points = marker.optional_member("points")) {
    const auto elements = points->elements();
    if (!elements) return;
    count = elements->size();
    for (const Field& point : *elements) {
      if (!read_point(point)) return;
    }
  }
  if (const auto colors = marker.optional_member("colors")) check_colors(*colors, count, type);
  if (const auto mesh = marker.optional_member("mesh_resource")) mesh->to_text();
  for (const char* const name : {"frame_locked", "mesh_use_embedded_materials"}) {
    if (const auto flag = marker.optional_member(name)) flag->boolean();
  }
}

/// Members that the ICD wants in each marker and the measured server does not miss.
void check_appearance(const Field& marker) {
  if (const auto scale = marker.member("scale", Measured::Takes)) read_point(*scale);
  if (const auto color = marker.member("color", Measured::Takes)) read_color(*color);
  if (const auto lifetime = marker.optional_member("lifetime")) check_lifetime(*lifetime);
  if (const auto text = marker.optional_member("text")) text->to_text();
}

/// Alpha 0: "the object will appear invisible" (ICD 6.6), unless its points or its mesh have own colors.
void check_alpha(const Field& marker) {
  const Json& all = marker.value();
  const auto shows = [](const Json& color) {
    return color.is_object() && color.contains("a") && color["a"].is_number() && color["a"].get<double>() > 0;
  };
  const bool by_color = !all.contains("color") || shows(all["color"]);
  const bool by_points = all.contains("colors") && std::ranges::any_of(all["colors"], shows);
  const bool by_mesh =
      all.contains("mesh_use_embedded_materials") && all["mesh_use_embedded_materials"] == true;
  if (by_color || by_points || by_mesh) return;
  marker.findings().add_remark(marker.path() + ".color.a: a marker with 0 is invisible (ICD 6.6)");
}

/// A display cannot show these, or shows them wrongly.
void check_drawable(const Field& marker, std::int64_t type) {
  const Json& all = marker.value();
  const auto told = [&](const char* sentence) { marker.findings().add_remark(marker.path() + sentence); };
  if (type == kLineList && all.contains("points") && all["points"].size() % 2 != 0)
    told(".points: a line list has two points for each line");
  if (type == kText && (!all.contains("text") || all["text"] == ""))
    told(".text: a text marker without text");
  if (!all.contains("scale") || !all["scale"].is_object()) return;
  const bool is_negative = std::ranges::any_of(
      all["scale"], [](const Json& part) { return part.is_number() && part.get<double>() < 0; });
  if (is_negative) told(".scale: negative");
}

bool read_marker(const Field& marker, MappingMessage& message) {
  if (!marker.is_object()) return false;
  read_header(marker, message.stamps);
  auto change = read_identity(marker);
  const auto shape = marker.integer("type", 0, kLastType);
  const auto kind = marker.integer("action", 0, 3);
  const auto place = marker.member("pose").and_then(read_pose);
  if (!change || !shape || !kind || !place) return false;
  if (*kind == 1) marker.member("action")->add_violation("expected 0, 2 or 3 (ICD 6.6)", Measured::Takes);
  check_appearance(marker);
  check_geometry(marker, *shape);
  if (*kind == 0) {
    check_alpha(marker);
    check_drawable(marker, *shape);
  }
  change->action = *kind;
  change->x = place->position.x;
  message.parts.push_back({"marker", change->ns});
  message.markers.push_back(*std::move(change));
  return true;
}

std::optional<MappingMessage> read_markers(Json& document, Format /*format*/, Findings& findings) {
  const Field body(document, "", findings);
  const auto elements = body.member("markers").and_then(&Field::elements);
  if (!elements) return std::nullopt;
  MappingMessage message;
  for (const Field& marker : *elements) {
    if (!read_marker(marker, message)) return std::nullopt;
  }
  return message;
}

std::optional<MappingMessage> read_state(Json& document, Format /*format*/, Findings& findings) {
  const Field body(document, "", findings);
  if (!body.is_object()) return std::nullopt;
  MappingMessage message;
  if (!body.optional_member("header")) findings.add_measured_refusal("Missing field 'header'");
  read_header(body, message.stamps);
  const auto elements = body.member("poses").and_then(&Field::elements);
  if (!elements) return std::nullopt;
  for (const Field& pose : *elements) {
    const auto name = pose.text("name");
    const auto place = read_pose(pose);
    if (!name || !place) return std::nullopt;
    if (!is_robot_name(*name)) {
      pose.member("name")->add_violation("expected 1 to 10 letters, digits and underscores (ICD 2)",
                                         Measured::Takes);
    }
    message.parts.push_back({"pose", *name});
  }
  return message;
}

/// The messages of a URI.
struct Reader {
  std::string_view uri;
  std::optional<MappingMessage> (*read)(Json& document, Format format, Findings& findings);
};
constexpr Reader kReaders[] = {
    {kMapUri, read_named_map}, {kStateUri, read_state}, {kMarkersUri, read_markers}};
static_assert(std::ranges::equal(kReaders, kMappingFunctions, {}, &Reader::uri, &Function::uri));

}  // namespace

std::optional<MapMessage> read_map(const Json& document, Format format, Findings& findings) {
  const Field body(document, "", findings);
  const auto type = body.member("type");
  const auto kind = type.and_then(&Field::to_text);
  const auto msg = body.member("msg");
  if (!kind || !msg || !msg->is_object()) return std::nullopt;
  MapMessage message;
  auto name = read_name(body);
  if (!name) return std::nullopt;
  message.name = std::move(*name);
  read_header(*msg, message.stamps);
  if (*kind == "OccupancyGrid") return read_grid_message(*msg, format, std::move(message));
  if (*kind == "PointCloud2") return read_cloud_message(*msg, format, std::move(message));
  return type->add_violation("expected \"OccupancyGrid\" or \"PointCloud2\" (ICD 6.4)");
}

std::optional<MappingMessage> read_mapping(const std::string& body, Format format, Judgement& judgement) {
  Findings& findings = judgement.findings;
  auto read = read_document(body, format);
  if (!read) {
    const std::string name = format == Format::JsonText ? "JSON" : "CBOR";
    findings.add_violation(name + " parsing failed: " + read.error(), Measured::Refuses, 400);
    return std::nullopt;
  }
  if (const auto& repeated = read->repeated) {
    findings.add_violation("'" + *repeated + "' is given twice", Measured::Takes);
  }
  Json& document = judgement.message.emplace(std::move(read->value));
  if (document.is_object() && document.empty()) return std::nullopt;  // asks if the token is accepted
  const auto* const reader = std::ranges::find(kReaders, judgement.uri, &Reader::uri);
  icd::require(reader != std::end(kReaders));
  return reader->read(document, format, findings);
}

}  // namespace adit::rehearsal
