#include "rehearsal/command_post/messages.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>

#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/mapping.hpp"

namespace adit::rehearsal {
namespace {

/// zlib's counter is 32 bits wide; no map's data is larger (kMostMapBytes).
unsigned long crc_of(const std::string& data) {
  return crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
}

/// Puts what `data` is in the place of what it holds.
void describe_data(Json& document, const std::optional<MapMessage>& map) {
  if (!document.is_object()) return;
  const auto msg = document.find("msg");
  if (msg == document.end() || !msg->is_object() || !msg->contains("data")) return;
  Json& data = (*msg)["data"];
  if (map) {
    data = {{"bytes", map->data.size()}, {"crc32", crc_of(map->data)}};
  } else {
    data = {{"unread", data.type_name()}};
  }
}

std::optional<MappingMessage> read_named_map(Json& document, Format format, Findings& findings) {
  auto map = read_map(document, format, findings);
  describe_data(document, map);
  if (!map) return std::nullopt;
  MappingMessage message;
  message.stamps = map->stamps;
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
    if (*value < 0 || *value > 1) color.member(name)->breaks("expected 0 to 1 (ICD 6.6)", Measured::Takes);
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
        lifetime.breaks("expected integers secs and nsecs", Measured::Takes);
        return;
      }
    }
  } else if (!value.is_number() || !(value.get<double>() >= 0)) {
    lifetime.breaks("expected seconds from 0", Measured::Takes);
  }
}

/// ns and id, optional by the ICD; the measured server wants both.
std::optional<MarkerChange> read_identity(const Field& marker) {
  const auto ns = marker.optional_member("ns");
  const auto id = marker.optional_member("id");
  if (!ns) marker.findings().displeases("Missing field '" + marker.path() + ".ns'");
  if (!id) marker.findings().displeases("Missing field '" + marker.path() + ".id'");
  const auto number = id ? id->integer(INT32_MIN, INT32_MAX) : 0;
  const auto text = ns ? ns->text() : std::string();
  if (!number || !text) return std::nullopt;
  return MarkerChange{.ns = *text, .id = *number};
}

/// ROS's Marker has none, or one for each point, where its type is made of points and so has a use for them;
/// rviz takes one for each triangle too.
void check_colors(const Field& colors, std::size_t points, std::int64_t type) {
  const auto elements = colors.elements();
  if (!elements) return;
  for (const Field& color : *elements) {
    if (!read_color(color)) return;
  }
  const bool has_use = (type >= kLineStrip && type <= kPoints) || type == kTriangleList;
  const bool for_triangles = type == kTriangleList && elements->size() == points / 3;
  if (has_use && !elements->empty() && elements->size() != points && !for_triangles) {
    colors.breaks("expected none or one for each point", Measured::Takes);
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
  if (const auto mesh = marker.optional_member("mesh_resource")) mesh->text();
  for (const char* const name : {"frame_locked", "mesh_use_embedded_materials"}) {
    if (const auto flag = marker.optional_member(name)) flag->boolean();
  }
}

/// Members that the ICD wants in each marker and the measured server does not miss.
void check_looks(const Field& marker) {
  if (const auto scale = marker.member("scale", Measured::Takes)) read_point(*scale);
  if (const auto color = marker.member("color", Measured::Takes)) read_color(*color);
  if (const auto lifetime = marker.optional_member("lifetime")) check_lifetime(*lifetime);
  if (const auto text = marker.optional_member("text")) text->text();
}

/// Alpha 0: "the object will appear invisible" (ICD 6.6), unless its points or its mesh have colors of their
/// own.
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
  marker.findings().tells(marker.path() + ".color.a: a marker with 0 is invisible (ICD 6.6)");
}

/// A display cannot show these, or not as they were meant.
void check_sense(const Field& marker, std::int64_t type) {
  const Json& all = marker.value();
  const auto told = [&](const char* sentence) { marker.findings().tells(marker.path() + sentence); };
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
  const auto pose = marker.member("pose");
  const auto place = pose ? read_pose(*pose) : std::nullopt;
  if (!change || !shape || !kind || !place) return false;
  if (*kind == 1) marker.member("action")->breaks("expected 0, 2 or 3 (ICD 6.6)", Measured::Takes);
  check_looks(marker);
  check_geometry(marker, *shape);
  if (*kind == 0) {
    check_alpha(marker);
    check_sense(marker, *shape);
  }
  change->action = *kind;
  change->x = place->position.x;
  message.parts.push_back({"marker", change->ns});
  message.markers.push_back(*std::move(change));
  return true;
}

std::optional<MappingMessage> read_markers(const Json& document, Findings& findings) {
  const Field body(document, "", findings);
  const auto markers = body.member("markers");
  const auto elements = markers ? markers->elements() : std::nullopt;
  if (!elements) return std::nullopt;
  MappingMessage message;
  for (const Field& marker : *elements) {
    if (!read_marker(marker, message)) return std::nullopt;
  }
  return message;
}

std::optional<MappingMessage> read_state(const Json& document, Findings& findings) {
  const Field body(document, "", findings);
  if (!body.is_object()) return std::nullopt;
  MappingMessage message;
  if (!body.optional_member("header")) findings.displeases("Missing field 'header'");
  read_header(body, message.stamps);
  const auto poses = body.member("poses");
  const auto elements = poses ? poses->elements() : std::nullopt;
  if (!elements) return std::nullopt;
  for (const Field& pose : *elements) {
    const auto name = pose.text("name");
    const auto place = read_pose(pose);
    if (!name || !place) return std::nullopt;
    if (!is_robot_name(*name)) {
      pose.member("name")->breaks("expected 1 to 10 letters, digits and underscores (ICD 2)",
                                  Measured::Takes);
    }
    message.parts.push_back({"pose", *name});
  }
  return message;
}

}  // namespace

std::optional<MappingMessage> read_mapping(const std::string& body, Format format, Judgement& judgement) {
  Findings& findings = judgement.findings;
  auto read = read_document(body, format);
  if (!read) {
    const std::string name = format == Format::JsonText ? "JSON" : "CBOR";
    findings.breaks(name + " parsing failed: " + read.error(), Measured::Refuses, 400);
    return std::nullopt;
  }
  if (const auto& repeated = read->repeated) {
    findings.breaks("'" + *repeated + "' is given twice", Measured::Takes);
  }
  Json& document = judgement.message.emplace(std::move(read->value));
  if (document.is_object() && document.empty()) return std::nullopt;  // asks if the token is accepted
  if (judgement.uri == kMapUri) return read_named_map(document, format, findings);
  return judgement.uri == kStateUri ? read_state(document, findings) : read_markers(document, findings);
}

}  // namespace adit::rehearsal
