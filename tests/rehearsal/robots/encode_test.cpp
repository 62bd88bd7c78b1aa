#include "rehearsal/robots/encode.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "rehearsal/robots/packing.hpp"

namespace adit::robots {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

Bytes inflated(const Bytes& packed) {
  Bytes bytes(1 << 20);
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, MAX_WBITS + 16), Z_OK);
  stream.next_in = const_cast<std::uint8_t*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = bytes.data();
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(stream.avail_in, 0u) << "something follows the gzip member";
  bytes.resize(stream.total_out);
  (void)inflateEnd(&stream);
  return bytes;
}

Bytes decoded(const std::string& base64_text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  EXPECT_EQ(base64_text.size() % 4, 0u);
  Bytes bytes;
  unsigned bits = 0, group = 0;
  for (const char c : base64_text) {
    if (c == '=') break;
    group = group << 6 | static_cast<unsigned>(alphabet.find(c));
    if ((bits += 6) >= 8) bytes.push_back(static_cast<std::uint8_t>(group >> (bits -= 8)));
  }
  return bytes;
}

std::optional<std::string> field(const HttpRequest& request, const std::string& name) {
  for (const auto& [key, value] : request.fields) {
    if (key == name) return value;
  }
  return std::nullopt;
}

Json body_of(const HttpRequest& request) {
  Bytes body(request.body.begin(), request.body.end());
  if (field(request, "Content-Encoding") == "gzip") body = inflated(body);
  return field(request, "Content-Type") == "application/cbor" ? Json::from_cbor(body) : Json::parse(body);
}

Bytes data_of(const Json& msg) {
  Bytes data;
  if (msg["data"].is_binary()) data = msg["data"].get_binary();
  if (msg["data"].is_string()) data = decoded(msg["data"].get<std::string>());
  if (msg["data"].is_array()) {
    for (const Json& cell : msg["data"]) data.push_back(cell == -1 ? kUnknown : cell.get<std::uint8_t>());
  }
  return msg.value("compression", "none") == "gzip" ? inflated(data) : data;
}

double seconds_of(const Json& time) {
  if (time.is_number()) return time;
  for (const auto& [secs, nsecs] :
       {std::pair("secs", "nsecs"), std::pair("sec", "nanosec"), std::pair("sec", "nsec")}) {
    if (time.contains(secs) && time.contains(nsecs) && time.size() == 2)
      return time[secs].get<double>() + time[nsecs].get<double>() * 1e-9;
  }
  return -1;
}

double stamp_of(const Json& header) {
  EXPECT_EQ(header["frame_id"], "darpa");
  return seconds_of(header["stamp"]);
}

Vector3 vector_of(const Json& json) {
  return {json["x"], json["y"], json["z"]};
}

Placement placement_of(const Json& json) {
  const Json& q = json["orientation"];
  return {vector_of(json["position"]), {q["x"], q["y"], q["z"], q["w"]}};
}

/// As it is, but for ROS's, which is twice as long.
Rotation posted(const Rotation& q, const Style& style) {
  const double length = style.ros ? 2 : 1;
  return {length * q.x, length * q.y, length * q.z, length * q.w};
}

Placement posted(const Placement& placement, const Style& style) {
  return {placement.position, posted(placement.orientation, style)};
}

class EveryStyle : public testing::TestWithParam<Style> {
 protected:
  Encoder encoder{"r1", GetParam(), "flux230{showroom"};
};

INSTANTIATE_TEST_SUITE_P(Encoder, EveryStyle, testing::ValuesIn(kStyles), [](const auto& style) {
  std::string name(style.param.name);
  std::erase(name, '-');
  return name;
});

TEST_P(EveryStyle, GridsDecodeToTheSameValues) {
  const Grid grid{.stamp = 1700000000.25,
                  .resolution = 0.2,
                  .width = 3,
                  .height = 2,
                  .origin = {.position = {-1.5, 2, 0}, .orientation = rotation_of(0.5)},
                  .cells = {0, 100, kUnknown, 55, 45, 0}};
  const HttpRequest request = encoder.encode(grid);
  EXPECT_EQ(request.method, "POST");
  const Json body = body_of(request);
  EXPECT_EQ(body["type"], "OccupancyGrid");
  EXPECT_EQ(body.contains("name"), !GetParam().ros);
  const Json& msg = body["msg"];
  EXPECT_DOUBLE_EQ(stamp_of(msg["header"]), grid.stamp);
  EXPECT_EQ(msg["info"]["resolution"], grid.resolution);
  EXPECT_EQ(msg["info"]["width"], grid.width);
  EXPECT_EQ(msg["info"]["height"], grid.height);
  EXPECT_EQ(placement_of(msg["info"]["origin"]), posted(grid.origin, GetParam()));
  EXPECT_EQ(data_of(msg), grid.cells);
}

TEST_P(EveryStyle, CloudsDecodeToTheSameBytes) {
  Cloud cloud{
      .stamp = 99.5,
      .origin = Placement{.position = {1, 2, 3}, .orientation = rotation_of(1)},
      .fields = {{"x", 0, kFloat32, 1}, {"y", 4, kFloat32, 1}, {"z", 8, kFloat32, 1}, {"ring", 12, 4, 2}},
      .point_step = 16,
      .data = {}};
  for (int i = 0; i < 16 * 1001; ++i) cloud.data.push_back(static_cast<std::uint8_t>(i * i >> 3));
  const Json body = body_of(encoder.encode(cloud));
  EXPECT_EQ(body["type"], "PointCloud2");
  const Json& msg = body["msg"];
  EXPECT_DOUBLE_EQ(stamp_of(msg["header"]), cloud.stamp);
  EXPECT_EQ(placement_of(msg["origin"]), posted(*cloud.origin, GetParam()));
  EXPECT_EQ(msg["point_step"], 16);
  EXPECT_EQ(msg["is_bigendian"], false);
  std::vector<CloudField> fields;
  for (const Json& one : msg["fields"])
    fields.push_back({one["name"], one["offset"], one["datatype"], one["count"]});
  EXPECT_EQ(fields, cloud.fields);
  EXPECT_EQ(data_of(msg), cloud.data);
}

TEST_P(EveryStyle, PosesDecodeToTheSameValues) {
  const State state{
      .stamp = 7.125, .robot = "r1", .pose = {.position = {4, -5.5, 6}, .orientation = rotation_of(2)}};
  const Json body = body_of(encoder.encode(state));
  EXPECT_DOUBLE_EQ(stamp_of(body["header"]), state.stamp);
  ASSERT_EQ(body["poses"].size(), 1u);
  EXPECT_EQ(body["poses"][0]["name"], "r1");
  const Placement pose = placement_of(body["poses"][0]);
  EXPECT_EQ(pose.position, state.pose.position);
  const Rotation zeros{0, 0, 0, 0};
  EXPECT_EQ(pose.orientation, GetParam().ros ? zeros : state.pose.orientation);
}

TEST_P(EveryStyle, MarkersDecodeToTheSameValues) {
  const Marker marker{.ns = "r1/artifact",
                      .id = 7,
                      .type = Marker::Text,
                      .action = Marker::Delete,
                      .position = {1, 2, 3.5},
                      .size = 0.5,
                      .color = {.r = 1, .g = 0.5, .b = 0, .a = 1},
                      .lifetime = 2.5,
                      .text = "Rope?"};
  const Json body = body_of(encoder.encode(Markers{3, {marker, marker}}));
  ASSERT_EQ(body["markers"].size(), 2u);
  const Json& json = body["markers"][1];
  EXPECT_DOUBLE_EQ(stamp_of(json["header"]), 3);
  EXPECT_EQ(json["ns"], marker.ns);
  EXPECT_EQ(json["id"], 7);
  EXPECT_EQ(json["type"], 9);
  EXPECT_EQ(json["action"], 2);
  EXPECT_EQ(placement_of(json["pose"]).position, marker.position);
  EXPECT_EQ(vector_of(json["scale"]), (Vector3{0.5, 0.5, 0.5}));
  EXPECT_EQ(json["color"]["g"], 0.5);
  EXPECT_EQ(json["color"]["a"], 1);
  EXPECT_EQ(seconds_of(json["lifetime"]), 2.5);
  EXPECT_EQ(json["text"], "Rope?");
}

TEST_P(EveryStyle, ReportsAreJsonAlways) {
  const HttpRequest request = encoder.encode(Report{"Fire Extinguisher", {1, -2.5, 3}});
  EXPECT_TRUE(field(request, "Content-Type")->starts_with("application/json"));
  EXPECT_FALSE(field(request, "Content-Encoding"));
  const Json body = Json::parse(request.body);
  EXPECT_EQ(body["type"], "Fire Extinguisher");
  EXPECT_EQ(vector_of(body), (Vector3{1, -2.5, 3}));
}

TEST_P(EveryStyle, EveryCallBearsTheToken) {
  const Message messages[] = {
      Grid{.stamp = 0, .resolution = 1, .width = 1, .height = 1, .origin = {}, .cells = {0}}, State{},
      Markers{}, Report{}, StatusQuery{}};
  for (const Message& message : messages) {
    const std::string bearer = GetParam().browser ? "bearer" : "Bearer";
    EXPECT_EQ(field(encoder.encode(message), "Authorization"), bearer + " flux230{showroom");
  }
}

TEST(Encoder, WritesRosDictionariesWhole) {
  Encoder encoder("r5", kStyles[4], "t");
  (void)encoder.encode(State{});
  const Cloud cloud{
      .stamp = 1, .origin = {}, .fields = {}, .point_step = 4, .data = {1, 2, 3, 4, 5, 6, 7, 8}};
  const Json msg = body_of(encoder.encode(cloud))["msg"];
  EXPECT_EQ(msg["header"]["seq"], 1);
  EXPECT_EQ(msg["header"]["stamp"], Json({{"sec", 1}, {"nanosec", 0}}));
  EXPECT_EQ(msg["height"], 2);
  EXPECT_EQ(msg["width"], 1);
  EXPECT_EQ(msg["row_step"], 8);
  EXPECT_EQ(msg["is_dense"], true);
  const Bytes data = data_of(msg);
  EXPECT_EQ(std::string(data.begin(), data.end()), "\1\2\3\4PADD\5\6\7\10PADD");
  const Json report = Json::parse(encoder.encode(Report{"Gas", {2, 0, -1}}).body);
  EXPECT_TRUE(report["x"].is_number_integer()) << "ROS clients send 2, not 2.0";
}

TEST(Encoder, SpeaksAsABrowserDoes) {
  Encoder encoder("r6", kStyles[5], "t");
  const HttpRequest request = encoder.encode(State{});
  EXPECT_EQ(request.target, "/state/update/");
  EXPECT_EQ(field(request, "Content-Type"), "application/json; charset=utf-8");
  const HttpRequest preflight = Encoder::preflight(request);
  EXPECT_EQ(preflight.method, "OPTIONS");
  EXPECT_EQ(preflight.target, "/state/update/");
  EXPECT_EQ(field(preflight, "Access-Control-Request-Method"), "POST");
  EXPECT_FALSE(field(preflight, "Authorization"));
}

TEST(TeamStyle, MixedGivesEachRobotTheNext) {
  const auto mixed = TeamStyle::parse("mixed"), ros = TeamStyle::parse("ros");
  ASSERT_TRUE(mixed && ros);
  for (std::size_t i = 0; i < 13; ++i) {
    EXPECT_EQ(mixed->of(i).name, kStyles[i % kStyles.size()].name);
    EXPECT_EQ(ros->of(i).name, "ros");
  }
  EXPECT_FALSE(TeamStyle::parse("morse"));
}

TEST(Packing, Base64IsThatOfRfc4648) {
  const std::pair<const char*, const char*> cases[] = {{"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"},
                                                       {"\xff\xfe\xfd", "//79"}};
  for (const auto& [text, encoded] : cases) {
    const std::string bytes(text);
    EXPECT_EQ(base64(Bytes(bytes.begin(), bytes.end())), encoded);
  }
}

TEST(Packing, GzipIsOneMemberThatInflatesToTheSame) {
  for (const std::size_t size : {0u, 1u, 5000u, 300'000u}) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 2654435761u >> 24);
    EXPECT_EQ(inflated(gzip(bytes)), bytes);
  }
}

}  // namespace
}  // namespace adit::robots
