// Every member of ROS 1's visualization_msgs/Marker, which the ICD encodes (2.2, 6.6), is sent upstream.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "codec/messages.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"

namespace adit::codec {
namespace {

using test::json;

/// visualization_msgs/Marker of ROS 1 (noetic), without its constants.
constexpr const char* kRosDefinition = R"(Header header
string ns
int32 id
int32 type
int32 action
geometry_msgs/Pose pose
geometry_msgs/Vector3 scale
std_msgs/ColorRGBA color
duration lifetime
bool frame_locked
geometry_msgs/Point[] points
std_msgs/ColorRGBA[] colors
string text
string mesh_resource
bool mesh_use_embedded_materials
)";

/// The structure of ICD 6.6, with its optional members.
constexpr const char* kIcdDefinition = R"(header.stamp <float>
header.frame_id <string>
ns <string>
id <int>
type <int>
action <int>
pose.position.x <float>
pose.position.y <float>
pose.position.z <float>
pose.orientation.x <float>
pose.orientation.y <float>
pose.orientation.z <float>
pose.orientation.w <float>
scale.x <float>
scale.y <float>
scale.z <float>
color.r <float>
color.g <float>
color.b <float>
color.a <float>
lifetime <duration>
text <string>
)";

std::set<std::string> members_of_ros() {
  std::set<std::string> names;
  std::istringstream lines(kRosDefinition);
  for (std::string type, name; lines >> type >> name;) names.insert(name);
  return names;
}

json point(double x, double y, double z) {
  return {{"x", x}, {"y", y}, {"z", z}};
}

json color(double r, double g, double b, double a) {
  return {{"r", r}, {"g", g}, {"b", b}, {"a", a}};
}

/// A value other than the default for each member, as it is sent upstream.
const std::map<std::string, json> kValues = {
    {"header", {{"stamp", 721.5}, {"frame_id", "darpa"}}},
    {"ns", "paths"},
    {"id", -7},
    {"type", 4},
    {"action", 2},
    {"pose",
     {{"position", point(1, 2, 3)}, {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", 0.6}, {"w", 0.8}}}}},
    {"scale", point(0.05, 0.1, 0.2)},
    {"color", color(1, 0.5, 0.25, 0.75)},
    {"lifetime", 2.5},
    {"frame_locked", true},
    {"points", {point(0, 0, 0), point(1.5, -2, 1e-3), point(-1e6, 0.1, 7)}},
    {"colors", {color(0, 0, 1, 1), color(0, 1, 0, 0.5), color(1, 0, 0, 0)}},
    {"text", "Fire \xf0\x9f\x94\xa5"},
    {"mesh_resource", "package://robots/meshes/husky.dae"},
    {"mesh_use_embedded_materials", true},
};

/// The required members of a marker, and points for the colors.
json least_marker() {
  return {{"type", 0},
          {"action", 0},
          {"pose", {{"position", point(0, 0, 0)}, {"orientation", {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}}}},
          {"scale", point(0, 0, 0)},
          {"color", color(0, 0, 0, 0)},
          {"points", kValues.at("points")}};
}

/// The Command Post's reading of a marker that a client sent in this body.
json sent_upstream(Format format, const std::string& body) {
  const auto document = decode({.format = format}, Split::Nothing, body);
  if (!document) return document.error().sentence;
  const auto update = read_markers_update(*document, {});
  if (!update) return update.error().sentence;
  return json::from_cbor(write_markers_update(*update).to_vector())["markers"][0];
}

json through_json(const json& marker) {
  return sent_upstream(Format::Json, test::as_json({{"markers", json::array({marker})}}));
}
json through_cbor(const json& marker) {
  return sent_upstream(Format::Cbor, test::as_cbor({{"markers", json::array({marker})}}));
}

TEST(Marker, HasAllMembersOfRos) {
  std::set<std::string> tested;
  for (const auto& [name, value] : kValues) tested.insert(name);
  EXPECT_EQ(tested, members_of_ros());
}

/// The value at "pose.position.x".
const json& at_path(const json& marker, const std::string& path) {
  const json* value = &marker;
  std::istringstream names(path);
  for (std::string name; std::getline(names, name, '.');) value = &value->at(name);
  return *value;
}

/// The ICD's name of the type of a value: 1.0 is a float, 1 an int. A duration is sent as a float.
std::string kind_of(const json& value) {
  if (value.is_number_float()) return "<float>";
  return value.is_number() ? "<int>" : value.is_string() ? "<string>" : value.type_name();
}

TEST(Marker, HasEachMemberOfTheIcdInItsType) {
  const json whole(kValues), sent = through_json(whole);
  std::istringstream lines(kIcdDefinition);
  for (std::string path, kind; lines >> path >> kind;) {
    EXPECT_EQ(kind_of(at_path(sent, path)), kind == "<duration>" ? "<float>" : kind) << path;
    EXPECT_EQ(at_path(sent, path), at_path(whole, path)) << path;
  }
}

/// As text, in which 1.0 and 1 differ.
std::string kinds_of(const json& marker, const std::string& name) {
  return marker.value(name, json()).dump();
}

TEST(Marker, KeepsEachReceivedMember) {
  for (const auto& [name, value] : kValues) {
    json marker = least_marker();
    marker[name] = value;
    EXPECT_EQ(kinds_of(through_json(marker), name), value.dump()) << name;
    EXPECT_EQ(kinds_of(through_cbor(marker), name), value.dump()) << name;
  }
  EXPECT_EQ(through_json(kValues).dump(), json(kValues).dump());
  EXPECT_EQ(through_cbor(kValues).dump(), json(kValues).dump());
}

TEST(Marker, UsesDefaultsForAbsentAndNullMembers) {
  json marker = least_marker();
  marker.erase("points");
  const json without = through_json(marker);
  for (const char* name :
       {"frame_locked", "points", "colors", "mesh_resource", "mesh_use_embedded_materials"}) {
    EXPECT_FALSE(without.contains(name)) << name;
    marker[name] = nullptr;
  }
  EXPECT_EQ(through_json(marker), without);
  EXPECT_EQ(through_cbor(marker), without);
  marker["frame_locked"] = marker["mesh_use_embedded_materials"] = 0;  // C programs write 0 for false
  marker["points"] = marker["colors"] = json::array();
  marker["mesh_resource"] = "";
  EXPECT_EQ(through_json(marker), without);
}

std::string body_with_points(Format format, const std::string& raw) {
  json marker = least_marker();
  marker["points"] = "POINTS";
  const json message = {{"markers", json::array({marker})}};
  std::string body = format == Format::Json ? test::as_json(message) : test::as_cbor(message);
  const std::string place = format == Format::Json ? "\"POINTS\"" : "\x66POINTS";
  return body.replace(body.find(place), place.size(), raw);
}

TEST(Marker, ReadsNumbersInEachFormOfJson) {
  for (const char* const three : {"3", "3.0", "3e0", "0.03E+2", "300e-2"}) {
    const std::string points = std::string(R"([{"x":)") + three + R"(,"y":-0.0,"z":0}])";
    const json up = sent_upstream(Format::Json, body_with_points(Format::Json, points));
    EXPECT_EQ(up["points"], json::array({point(3, 0, 0)})) << three;
  }
}

TEST(Marker, ReadsNumbersInEachFormOfCbor) {
  using namespace std::string_literals;
  const std::string forms[] = {"\x03"s,       "\x18\x03"s,         "\x1b\0\0\0\0\0\0\0\x03"s,
                               "\xf9\x42\0"s, "\xfa\x40\x40\0\0"s, "\xfb\x40\x08\0\0\0\0\0\0"s};
  for (const std::string& three : forms) {
    const std::string points = "\x9f\xa3\x61x" + three + "\x61y\x20\x61z\xf9\xc0\x00\xff"s;  // -1 and -2.0
    const json up = sent_upstream(Format::Cbor, body_with_points(Format::Cbor, points));
    EXPECT_EQ(up["points"], json::array({point(3, -1, -2)})) << testing::PrintToString(three);
  }
}

struct Refused {
  const char* member;
  json value;
  const char* sentence;
};

TEST(Marker, IsRejectedWithTheNameOfTheMember) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const json one = point(1, 2, 3);
  const Refused rows[] = {
      {"frame_locked", "yes", "markers[0].frame_locked: expected true or false, got a string"},
      {"frame_locked", 2, "markers[0].frame_locked: expected true or false, got 2"},
      {"points", one, "markers[0].points: expected an array, got an object"},
      {"points", {one, 5}, "markers[0].points[1]: expected an object, got a whole number"},
      {"points", {one, {{"x", 1}, {"y", 2}}}, "markers[0].points[1].z: missing"},
      {"points", json::array({point(1, kNan, 3)}),
       "markers[0].points[0].y: expected a finite number, got nan"},
      {"points", json(100'001, json()), "markers[0].points: expected at most 100000, got 100001"},
      {"colors", 1, "markers[0].colors: expected an array, got a whole number"},
      {"colors", json(100'001, json()), "markers[0].colors: expected at most 100000, got 100001"},
      {"colors",
       {color(1, 1, 1, 1), color(1, 1, 1, 1), color(1, 1, 2, 1)},
       "markers[0].colors[2].b: expected a number from 0 to 1, got 2"},
      {"mesh_resource", 7, "markers[0].mesh_resource: expected a string, got a whole number"},
      {"mesh_resource", std::string(4097, 'x'),
       "markers[0].mesh_resource: expected at most 4096 bytes, got 4097"},
      {"mesh_use_embedded_materials", json::array(),
       "markers[0].mesh_use_embedded_materials: expected true or false, got an array"},
  };
  for (const Refused& row : rows) {
    json marker = least_marker();
    marker[row.member] = row.value;
    EXPECT_EQ(through_cbor(marker), row.sentence);
    if (std::string(row.sentence).ends_with("nan")) continue;  // JSON has no NaN
    EXPECT_EQ(through_json(marker), row.sentence);
  }
}

TEST(Marker,
     KeepsItsColorsHoweverManyPointsItHas) {  // rviz ignores a wrong number of colors and shows the marker
  const json one = json::array({color(1, 0, 0, 1)}), two = {color(1, 0, 0, 1), color(0, 1, 0, 1)};
  for (const int type : {1, 4, 8, 11}) {
    for (const int action : {0, 2}) {
      for (const json& points : {json::array(), json(kValues.at("points"))}) {
        for (const json& colors : {one, two}) {
          json marker = least_marker();
          marker["type"] = type;
          marker["action"] = action;
          marker["points"] = points;
          marker["colors"] = colors;
          const auto sent = through_json(marker);
          ASSERT_TRUE(sent.is_object()) << sent;
          EXPECT_EQ(sent["colors"], colors) << marker;
          EXPECT_EQ(through_cbor(marker), sent);
        }
      }
    }
  }
}

TEST(BytesOfAMarker, CoverItsSizeInAMessageAndInMemory) {
  test::Random random(12);
  for (int round = 0; round < 100; ++round) {
    const icd::MarkersUpdate update = test::random_markers(random);
    std::size_t bytes = 16, in_memory = 0;
    for (const icd::Marker& marker : update.markers) {
      bytes += bytes_of(marker);
      in_memory += sizeof marker + marker.points.size() * sizeof(icd::Point) +
                   marker.colors.size() * sizeof(icd::Color) + marker.text.size() +
                   marker.mesh_resource.size();
    }
    EXPECT_GE(bytes, write_markers_update(update).size());
    EXPECT_GE(bytes, in_memory);
  }
}

}  // namespace
}  // namespace adit::codec
