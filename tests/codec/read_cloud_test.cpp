// One row for each rule of the ICD about a PointCloud2 in POST /map/update, sent as JSON and as CBOR.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "codec/read_map.hpp"

namespace adit::codec {
namespace {

using test::Bytes;
using test::expect_map_answers;
using test::IcdRow;
using test::json;
using test::kInfinity;
using test::read_map;

TEST(ReadMapUpdate, RejectsAForbiddenCloud) {
  const IcdRow rows[] = {
      {"6.3.2", [](json& m) { m["msg"]["origin"] = 1; },
       "msg.origin: expected an object, got a whole number"},
      {"6.3.2", [](json& m) { m["msg"]["origin"]["orientation"]["w"] = nullptr; },
       "msg.origin.orientation.w: expected a number, got null"},
      {"6.3.2", [](json& m) { m["msg"]["origin"]["orientation"] = test::quaternion(0, 0, 0, 1e-9); },
       "msg.origin.orientation: expected a quaternion of length 1, got one too short to have a direction"},
      {"6.3.2", [](json& m) { m["msg"]["origin"]["orientation"] = test::quaternion(kInfinity, 0, 0, 1); },
       "msg.origin.orientation.x: expected a finite number, got inf"},
      {"6.4", [](json& m) { m = m["msg"]; },
       "type, msg: missing (found fields: put header, fields, point_step and data into msg)"},
      {"6.3.2", [](json& m) { m["msg"].erase("fields"); }, "msg.fields: missing"},
      {"6.3.2", [](json& m) { m["msg"]["fields"] = json::object(); },
       "msg.fields: expected an array, got an object"},
      {"6.3.2", [](json& m) { m["msg"]["fields"] = json::array(); },
       "msg.fields: expected at least x, y and z, got an empty list"},
      {"6.3.2",
       [](json& m) { m["msg"]["fields"].get_ref<json::array_t&>().resize(257, m["msg"]["fields"][3]); },
       "msg.fields: expected at most 256 fields, got 257"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][2] = "z"; },
       "msg.fields[2]: expected an object, got a string"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][2].erase("name"); }, "msg.fields[2].name: missing"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][2]["name"] = 3; },
       "msg.fields[2].name: expected a string, got a whole number"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][2].erase("offset"); }, "msg.fields[2].offset: missing"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][2]["offset"] = -8; },
       "msg.fields[2].offset: expected a whole number from 0 to 4294967295, got -8"},
      {"6.3.2 and kills a server", [](json& m) { m["msg"]["fields"][3]["offset"] = 13; },
       "msg.fields[3].offset: expected the field to end within point_step 16, got 13 + 4 x 1 = 17"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][3].erase("datatype"); }, "msg.fields[3].datatype: missing"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][3]["datatype"] = 0; },
       "msg.fields[3].datatype: expected a whole number from 1 to 8, got 0"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][3]["datatype"] = 9; },
       "msg.fields[3].datatype: expected a whole number from 1 to 8, got 9"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][3].erase("count"); }, "msg.fields[3].count: missing"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][3]["count"] = 0; },
       "msg.fields[3].count: expected a whole number from 1 to 4294967295, got 0"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][3]["count"] = 4294967295; },
       "msg.fields[3].offset: expected the field to end within point_step 16, got 12 + 4 x 4294967295 = "
       "17179869192"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][1]["name"] = "Y"; }, "msg.fields: missing field \"y\""},
      {"6.3.2", [](json& m) { m["msg"]["fields"][3]["name"] = "x"; },
       "msg.fields: expected one field \"x\", got 2"},
      {"6.3.2", [](json& m) { m["msg"]["fields"][1]["datatype"] = 6; },
       "msg.fields[1].datatype: expected 7 or 8 for \"y\", got 6"},
      {"6.3.2",
       [](json& m) {
         m["msg"]["fields"][2]["datatype"] = 8;
         m["msg"]["fields"][2]["offset"] = 8;
       },
       "msg.fields[2].datatype: expected 7 as for \"x\", got 8"},
      {"6.3.2", [](json& m) { m["msg"]["is_bigendian"] = "no"; },
       "msg.is_bigendian: expected true or false, got a string"},
      {"6.3.2", [](json& m) { m["msg"]["is_bigendian"] = 2; },
       "msg.is_bigendian: expected true or false, got 2"},
      {"6.3.2", [](json& m) { m["msg"].erase("point_step"); }, "msg.point_step: missing"},
      {"6.3.2 and kills a server", [](json& m) { m["msg"]["point_step"] = 0; },
       "msg.point_step: expected a whole number from 1 to 65536, got 0"},
      {"6.3.2", [](json& m) { m["msg"]["point_step"] = 65537; },
       "msg.point_step: expected a whole number from 1 to 65536, got 65537"},
      {"6.3.2 and kills a server", [](json& m) { m["msg"]["point_step"] = 8; },
       "msg.fields[2].offset: expected the field to end within point_step 8, got 8 + 4 x 1 = 12"},
      {"6.3.2", [](json& m) { m["msg"]["data"] = json::binary(Bytes(33, 0)); },
       "msg.data: expected a multiple of point_step 16, got 33 bytes"},
      {"6.3.2",
       [](json& m) {
         m["msg"]["data"] = json::binary(test::compressed(Bytes(31, 0)));
         m["msg"]["compression"] = "gzip";
       },
       "msg.data: expected a multiple of point_step 16, got 31 bytes"},
  };
  expect_map_answers(rows, test::good_cloud());
}

TEST(ReadMapUpdate, RejectsACloudOverTheLargestMap) {
  icd::Rules rules;
  rules.map_bytes = 1600;
  const IcdRow rows[] = {
      {"setting", [](json& m) { m["msg"]["data"] = json::binary(Bytes(1600, 0)); }, "accepted"},
      {"setting", [](json& m) { m["msg"]["data"] = json::binary(Bytes(1616, 0)); },
       "413: msg.data: expected at most 1600 bytes (the setting rules.map_bytes), got 1616"},
      {"setting and a gzip bomb",
       [](json& m) {
         m["msg"]["data"] = json::binary(test::compressed(Bytes(16'000'000, 0)));
         m["msg"]["compression"] = "gzip";
       },
       "413: msg.data: expected at most 1600 bytes, got more"},
  };
  expect_map_answers(rows, test::good_cloud(), rules);
  json large = test::good_cloud();
  large["msg"]["data"] = json::binary(Bytes(1616, 0));
  EXPECT_EQ(read_map(Format::Cbor, test::as_cbor(large), rules).error().setting, "rules.map_bytes");
}

TEST(ReadMapUpdate, KeepsThePointsOfAllGzipMembers) {  // RFC 1952 2.2
  Bytes points(48);
  std::iota(points.begin(), points.end(), std::uint8_t{0});
  for (const std::size_t first : {0, 1, 15, 16, 32, 47, 48}) {  // bytes; only the last member may hold points
    const auto middle = points.begin() + static_cast<std::ptrdiff_t>(first);
    Bytes members = test::compressed(Bytes(points.begin(), middle));
    const Bytes last = test::compressed(Bytes(middle, points.end()));
    members.insert(members.end(), last.begin(), last.end());
    json message = test::good_cloud();
    message["msg"]["compression"] = "gzip";
    message["msg"]["data"] = json::binary(members);
    const auto map = read_map(Format::Cbor, test::as_cbor(message));
    ASSERT_TRUE(map) << first << map.error().sentence;
    EXPECT_EQ(map->data.bytes.to_vector(), points) << first;
    EXPECT_EQ(map->data.raw_size, points.size());
  }
}

TEST(ReadMapUpdate, KeepsTheMembersAndPointsOfACloud) {
  json message = test::good_cloud();
  message["msg"]["is_bigendian"] = 0;
  const auto map = read_map(Format::Json, test::as_json(message));
  ASSERT_TRUE(map.has_value());
  const auto& cloud = std::get<icd::PointCloud2>(map->msg);
  EXPECT_EQ(cloud.header.stamp, 721.4);
  EXPECT_EQ(cloud.origin, (icd::Pose{{1.5, -2.5, 0.25}, {0, 0, 0.6, 0.8}}));
  ASSERT_EQ(cloud.fields.size(), 4U);
  EXPECT_EQ(cloud.fields[3], (icd::FieldSchema{"rgba", 12, icd::Datatype::Uint32, 1}));
  EXPECT_FALSE(cloud.is_bigendian);
  EXPECT_EQ(cloud.point_step, 16U);
  EXPECT_EQ(map->data.compression, icd::Compression::None);
  EXPECT_EQ(map->data.raw_size, 32U);
  EXPECT_EQ(map->data.bytes, icd::ChunkedBytes(Bytes(32, 0x41)));
}

struct Rows {
  std::size_t width, height, row_step;
};

/// A cloud with that many rows of 16-byte points, and its data without and with padding.
json organised_cloud(const Rows& rows, Bytes& points, Bytes& padded) {
  for (std::size_t row = 0; row < rows.height; ++row) {
    for (std::size_t i = 0; i < rows.row_step; ++i) {
      const auto byte = static_cast<std::uint8_t>(row * 131 + i * 7 + i / 251);
      padded.push_back(byte);
      if (i < rows.width * 16) points.push_back(byte);
    }
  }
  json message = test::good_cloud();
  message["msg"]["width"] = rows.width;
  message["msg"]["height"] = rows.height;
  message["msg"]["row_step"] = rows.row_step;
  message["msg"]["data"] = json::binary(padded);
  return message;
}

TEST(ReadMapUpdate, DropsTheRowPaddingOfAnOrganisedCloud) {
  // 85: padding is not a whole number of points. In the larger clouds rows begin and end anywhere in a
  // chunk.
  for (const Rows& rows : {Rows{5, 4, 88}, {5, 4, 85}, {1, 2, 17}, {640, 480, 10'241}, {3, 2, 200'000}}) {
    Bytes points, padded;
    json message = organised_cloud(rows, points, padded);
    const auto expect_points = [&](Format format) {
      const auto map =
          read_map(format, format == Format::Json ? test::as_json(message) : test::as_cbor(message));
      ASSERT_EQ(test::sentence_of(map), "accepted") << rows.row_step;
      EXPECT_EQ(map->data.raw_size, points.size()) << rows.row_step;
      EXPECT_TRUE(map->data.bytes == icd::ChunkedBytes(points)) << rows.row_step;
    };
    expect_points(Format::Json);
    expect_points(Format::Cbor);
    message["msg"]["data"] = json::binary(test::compressed(padded));
    message["msg"]["compression"] = "gzip";
    expect_points(Format::Json);
    expect_points(Format::Cbor);
    message["msg"]["is_bigendian"] = true;
    for (std::size_t i = 0; i < points.size(); i += 4) std::reverse(&points[i], &points[i] + 4);
    expect_points(Format::Cbor);
  }
}

/// As real drivers write them.
TEST(ReadMapUpdate, IgnoresInconsistentRowsOfACloud) {
  Bytes points, padded;
  const json message = organised_cloud({5, 4, 96}, points, padded);  // each row has 6 points with its padding
  const std::pair<const char*, json> changes[] = {
      {"row_step", 0},   {"row_step", 384},       {"row_step", 24},    {"row_step", 80},
      {"row_step", 112}, {"row_step", "96"},      {"row_step", -96},   {"row_step", nullptr},
      {"height", 1},     {"height", 3},           {"height", nullptr}, {"width", 6},
      {"width", 24},     {"width", json::array()}};
  for (const auto& [name, value] : changes) {
    json changed = message;
    changed["msg"][name] = value;
    const auto map = read_map(Format::Cbor, test::as_cbor(changed));
    ASSERT_EQ(test::sentence_of(map), "accepted") << name << value;
    EXPECT_TRUE(map->data.bytes == icd::ChunkedBytes(padded)) << name << value;
  }
  json flat = message;
  flat["msg"]["height"] = 1;
  flat["msg"]["row_step"] = 384;
  EXPECT_EQ(read_map(Format::Cbor, test::as_cbor(flat))->data.raw_size, 384U);
}

TEST(ReadMapUpdate, AcceptsACloudWithoutOriginByteOrderOrPoints) {
  json message = test::good_cloud();
  message["msg"].erase("origin");
  message["msg"].erase("is_bigendian");
  message["msg"]["data"] = json::binary({});
  const auto map = read_map(Format::Cbor, test::as_cbor(message));
  ASSERT_TRUE(map.has_value());
  EXPECT_FALSE(std::get<icd::PointCloud2>(map->msg).origin.has_value());
  EXPECT_FALSE(std::get<icd::PointCloud2>(map->msg).is_bigendian);
  EXPECT_EQ(map->data.raw_size, 0U);
}

}  // namespace
}  // namespace adit::codec
