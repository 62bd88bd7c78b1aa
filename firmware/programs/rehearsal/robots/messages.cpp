#include "rehearsal/robots/messages.hpp"

#include <sodium/utils.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <nlohmann/json.hpp>

namespace adit::robots {

Rotation rotation_of(double yaw) {
  return {.x = 0, .y = 0, .z = std::sin(yaw / 2), .w = std::cos(yaw / 2)};
}

MessageKind kind_of(const Message& message) {
  return static_cast<MessageKind>(message.index());  // the variant's order is the enumeration's
}
static_assert(std::variant_size_v<Message> == kKinds - 1);  // a preflight is no message
static_assert(
    std::is_same_v<std::variant_alternative_t<static_cast<std::size_t>(MessageKind::Status), Message>,
                   StatusQuery>);

namespace {

struct KindRow {
  std::string_view name;
  const char* target;
};
/// In the order of MessageKind.
constexpr KindRow kRows[] = {{"grid", "/map/update"},
                             {"cloud", "/map/update"},
                             {"state", "/state/update"},
                             {"markers", "/markers/update"},
                             {"report", "/api/artifact_reports"},
                             {"status", "/api/status"},
                             {"preflight", "/api/status"}};
static_assert(std::size(kRows) == kKinds);

const KindRow& row_of(MessageKind kind) {
  return kRows[static_cast<std::size_t>(kind)];
}

}  // namespace

std::string_view name_of(MessageKind kind) {
  return row_of(kind).name;
}

std::expected<TeamStyle, std::string> TeamStyle::parse(std::string_view name) {
  if (name == "mixed") return TeamStyle{};
  const auto* const style = std::ranges::find(kStyles, name, &Style::name);
  if (style == kStyles.end()) return std::unexpected("unknown style '" + std::string(name) + "'");
  return TeamStyle{.styles = {style, 1}};
}

std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes) {
  constexpr int kGzipFraming = 16;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzipFraming, 8,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();  // the one way in which these arguments can fail
  }
  std::vector<std::uint8_t> packed(deflateBound(&stream, bytes.size()));
  // zlib only reads its input, which is not const, and must not be null even if it is empty.
  static std::uint8_t nothing = 0;
  stream.next_in = bytes.empty() ? &nothing : const_cast<std::uint8_t*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = packed.data();
  stream.avail_out = static_cast<uInt>(packed.size());
  (void)deflate(&stream, Z_FINISH);  // ends in one call: the output has room for the bound
  packed.resize(stream.total_out);
  (void)deflateEnd(&stream);
  return packed;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr int kPadded = sodium_base64_VARIANT_ORIGINAL;
  std::string text(sodium_base64_encoded_len(bytes.size(), kPadded), '\0');
  (void)sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), kPadded);
  text.pop_back();  // its terminating NUL
  return text;
}

namespace {

using Json = nlohmann::json;

std::string text_of(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

/// The members of one message, in one style.
class Body {
 public:
  Body(const std::string& robot, const Style& style, std::uint32_t seq)
      : robot_(robot), style_(style), seq_(seq) {}

  Json operator()(const Grid& grid) const {
    Json info = {{"resolution", number(grid.resolution)},
                 {"width", grid.width},
                 {"height", grid.height},
                 {"origin", placement(grid.origin)}};
    if (style_.ros) info["map_load_time"] = {{"secs", 0}, {"nsecs", 0}};
    Json msg = {{"header", header(grid.stamp)}, {"info", std::move(info)}};
    if (style_.data == DataForm::Integers) {
      Json::array_t cells;
      cells.reserve(grid.cells.size());
      for (const std::uint8_t cell : grid.cells) cells.emplace_back(cell == kUnknown ? -1 : int{cell});
      msg["data"] = std::move(cells);
    } else {
      put_data(msg, grid.cells);
    }
    return map("OccupancyGrid", std::move(msg));
  }

  Json operator()(const Cloud& cloud) const {
    Json fields = Json::array();
    for (const CloudField& field : cloud.fields) {
      fields.push_back({{"name", field.name},
                        {"offset", field.offset},
                        {"datatype", field.datatype},
                        {"count", field.count}});
    }
    Json msg = {{"header", header(cloud.stamp)},
                {"fields", std::move(fields)},
                {"point_step", cloud.point_step},
                {"is_bigendian", false}};
    if (cloud.origin) msg["origin"] = placement(*cloud.origin);
    if (style_.ros) {
      put_rows(msg, cloud);
    } else {
      put_data(msg, cloud.data);
    }
    return map("PointCloud2", std::move(msg));
  }

  Json operator()(const RobotState& state) const {
    Json pose = placement(state.pose);
    pose["name"] = state.robot;
    // A lazy client of the field: it fills in the position and leaves the orientation as ROS made it.
    if (style_.ros) pose["orientation"] = {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 0}};
    return {{"header", header(state.stamp)}, {"poses", Json::array({std::move(pose)})}};
  }

  Json operator()(const Markers& update) const {
    Json markers = Json::array();
    for (const Marker& marker : update.markers) markers.push_back(one(marker, update.stamp));
    return {{"markers", std::move(markers)}};
  }

  Json operator()(const Report& report) const {
    Json body = vector(report.position);
    body["type"] = report.type;
    if (style_.ros || style_.browser) body["name"] = robot_;  // as in the ICD's own example (5.2)
    return body;
  }

  Json operator()(const StatusQuery&) const { return nullptr; }

 private:
  Json number(double value) const {
    if (style_.ros && value == std::trunc(value)) return static_cast<std::int64_t>(value);
    return value;
  }

  Json vector(const Vector3& v) const { return {{"x", number(v.x)}, {"y", number(v.y)}, {"z", number(v.z)}}; }

  Json placement(const Placement& placement) const {
    Rotation q = placement.orientation;
    if (style_.ros) q = {2 * q.x, 2 * q.y, 2 * q.z, 2 * q.w};  // as of a client that does not normalise
    return {
        {"position", vector(placement.position)},
        {"orientation", {{"x", number(q.x)}, {"y", number(q.y)}, {"z", number(q.z)}, {"w", number(q.w)}}}};
  }

  /// Message by message as ROS 1, ROS 2 and some C++ code write it.
  Json ros_time(double seconds) const {
    constexpr const char* kNames[][2] = {{"secs", "nsecs"}, {"sec", "nanosec"}, {"sec", "nsec"}};
    const auto& [secs, nsecs] = kNames[seq_ % std::size(kNames)];
    const double whole = std::floor(seconds);
    return {{secs, static_cast<std::int64_t>(whole)},
            {nsecs, static_cast<std::int64_t>((seconds - whole) * 1e9)}};
  }

  Json header(double stamp) const {
    if (!style_.ros) return {{"stamp", stamp}, {"frame_id", "darpa"}};
    return {{"seq", seq_}, {"stamp", ros_time(stamp)}, {"frame_id", "darpa"}};
  }

  void put_data(Json& msg, const std::vector<std::uint8_t>& bytes) const {
    const std::vector<std::uint8_t>& packed = style_.gzip_data ? gzip(bytes) : bytes;
    if (style_.data == DataForm::Bytes) {
      msg["data"] = Json::binary(packed);
    } else {
      msg["data"] = base64(packed);
    }
    if (style_.gzip_data) msg["compression"] = "gzip";
  }

  /// Two rows with the padding of one point, if of one length; else one, as of a cloud that is not organised.
  void put_rows(Json& msg, const Cloud& cloud) const {
    const std::size_t points = cloud.data.size() / cloud.point_step;
    const std::size_t rows = points > 0 && points % 2 == 0 ? 2 : 1, row = cloud.data.size() / rows;
    std::vector<std::uint8_t> data;
    for (std::size_t at = 0; at < cloud.data.size(); at += row) {
      data.insert(data.end(), &cloud.data[at], &cloud.data[at] + row);
      for (std::size_t i = 0; rows > 1 && i < cloud.point_step; ++i)
        data.push_back(static_cast<std::uint8_t>(kRowPadding[i % kRowPadding.size()]));
    }
    msg["height"] = rows;
    msg["width"] = points / rows;
    msg["row_step"] = data.size() / rows;
    msg["is_dense"] = true;
    put_data(msg, data);
  }

  Json map(const char* type, Json msg) const {
    Json body = {{"type", type}, {"msg", std::move(msg)}};
    if (!style_.ros) body["name"] = robot_;
    return body;
  }

  Json one(const Marker& marker, double stamp) const {
    Json json = {{"header", header(stamp)},
                 {"ns", marker.ns},
                 {"id", marker.id},
                 {"type", static_cast<int>(marker.type)},
                 {"action", static_cast<int>(marker.action)},
                 {"pose", placement({.position = marker.position, .orientation = {}})},
                 {"scale", vector({marker.size, marker.size, marker.size})},
                 {"color",
                  {{"r", number(marker.color.r)},
                   {"g", number(marker.color.g)},
                   {"b", number(marker.color.b)},
                   {"a", number(marker.color.a)}}},
                 {"lifetime", marker.lifetime},
                 {"text", marker.text}};
    for (const Vector3& point : marker.points) json["points"].push_back(vector(point));
    if (style_.ros || !marker.mesh_resource.empty()) {
      json["mesh_resource"] = marker.mesh_resource;
      json["mesh_use_embedded_materials"] = !marker.mesh_resource.empty();
    }
    if (style_.ros) {
      json["lifetime"] = ros_time(marker.lifetime);
      json["frame_locked"] = false;
      if (marker.points.empty()) json["points"] = Json::array();
      json["colors"] = Json::array();
    }
    return json;
  }

  const std::string& robot_;
  const Style& style_;
  std::uint32_t seq_;
};

}  // namespace

Encoder::Encoder(std::string robot, const Style& style, std::string token)
    : robot_(std::move(robot)), style_(style), token_(std::move(token)) {}

HttpRequest Encoder::encode(const Message& message) {
  const MessageKind kind = kind_of(message);
  HttpRequest request{.method = "POST", .target = row_of(kind).target, .fields = {}, .body = {}};
  if (style_.browser) {
    request.target += '/';
    request.fields.emplace_back("Origin", kOrigin);
  }
  request.fields.emplace_back("Authorization", (style_.browser ? "bearer " : "Bearer ") + token_);
  if (kind == MessageKind::Status) {
    request.method = "GET";
    return request;
  }
  const Json body = std::visit(Body(robot_, style_, seq_++), message);
  const bool cbor = style_.cbor && kind != MessageKind::Report;  // ICD 4: scoring takes JSON alone
  request.body = cbor ? text_of(Json::to_cbor(body)) : body.dump();
  std::string type = cbor ? "application/cbor" : "application/json";
  if (style_.browser) type += "; charset=utf-8";
  request.fields.emplace_back("Content-Type", std::move(type));
  if (style_.gzip_body && kind != MessageKind::Report) {
    request.body =
        text_of(gzip({reinterpret_cast<const std::uint8_t*>(request.body.data()), request.body.size()}));
    request.fields.emplace_back("Content-Encoding", "gzip");
  }
  return request;
}

HttpRequest Encoder::preflight(const HttpRequest& request) {
  return {.method = "OPTIONS",
          .target = request.target,
          .fields = {{"Origin", kOrigin},
                     {"Access-Control-Request-Method", request.method},
                     {"Access-Control-Request-Headers",
                      request.method == "GET" ? "authorization" : "authorization,content-type"}},
          .body = {}};
}

}  // namespace adit::robots
