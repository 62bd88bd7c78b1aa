// A row for each rule of the ICD about POST /map/update, sent as JSON and as CBOR.
#include <gtest/gtest.h>

#include <limits>

#include "codec/icd_row.hpp"
#include "codec/messages.hpp"
#include "codec/read.hpp"
#include "scarce_memory.hpp"

namespace adit::codec {
namespace {

using test::Bytes;
using test::IcdRow;
using test::json;
using test::kNan;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

icd::Checked<icd::MapUpdate> read(Format format, const std::string& body, const icd::Rules& rules = {}) {
  auto document = decode({.format = format}, Split::MapData, body);
  if (!document) return std::unexpected(document.error());
  return read_map_update(std::move(*document), rules);
}

/// What both formats answer to each row. NaN and infinities exist in CBOR alone.
void expect_answers(std::span<const IcdRow> rows, const json& good, const icd::Rules& rules = {}) {
  for (const IcdRow& row : rows) {
    json message = good;
    row.change(message);
    EXPECT_EQ(test::sentence_of(read(Format::Cbor, test::as_cbor(message), rules)), row.sentence)
        << "ICD " << row.section << ", CBOR";
    if (row.sentence.ends_with("nan") || row.sentence.ends_with("inf")) continue;
    EXPECT_EQ(test::sentence_of(read(Format::Json, test::as_json(message), rules)), row.sentence)
        << "ICD " << row.section << ", JSON";
  }
}

TEST(ReadMapUpdate, RefusesWhatTheIcdForbidsInAnyMap) {
  const IcdRow rows[] = {
      {"6.4", [](json&) {}, "taken"},
      {"6.4", [](json& m) { m = json::array(); }, "the body: expected an object, got an array"},
      {"6.4", [](json& m) { m = "map"; }, "the body: expected an object, got a string"},
      {"6.4", [](json& m) { m.erase("type"); }, "type: missing"},
      {"6.4", [](json& m) { m["type"] = 1; }, "type: expected a string, got a whole number"},
      {"6.4", [](json& m) { m["type"] = "occupancygrid"; },
       "type: expected \"OccupancyGrid\" or \"PointCloud2\", got \"occupancygrid\""},
      {"6.4", [](json& m) { m["type"] = ""; },
       "type: expected \"OccupancyGrid\" or \"PointCloud2\", got \"\""},
      {"6.4", [](json& m) { m.erase("msg"); }, "msg: missing"},
      {"6.4", [](json& m) { m["msg"] = nullptr; }, "msg: expected an object, got null"},
      {"6.4", [](json& m) { m["msg"] = {1}; }, "msg: expected an object, got an array"},
      {"2, 6.4", [](json& m) { m["name"] = "ABCDEFGHIJK"; },
       "name: expected 1 to 10 letters, digits and underscores, got \"ABCDEFGHIJK\" "
       "(the setting robots[].alias gives a name to whoever calls itself so)"},
      {"2, 6.4", [](json& m) { m["name"] = "a-b"; },
       "name: expected 1 to 10 letters, digits and underscores, got \"a-b\" "
       "(the setting robots[].alias gives a name to whoever calls itself so)"},
      {"2, 6.4", [](json& m) { m["name"] = 7; }, "name: expected a string, got a whole number"},
      {"2, 6.4", [](json& m) { m["name"] = std::string("a\0b", 3); },
       "name: expected a string without NUL characters, got one with them"},
      {"6.3.1", [](json& m) { m["msg"]["header"] = 5; },
       "msg.header: expected an object, got a whole number"},
      {"6.1", [](json& m) { m["msg"]["header"]["frame_id"] = "map"; },
       "msg.header.frame_id: expected \"darpa\", got \"map\" (the setting rules.rewrite_frame_id takes any)"},
      {"6.1", [](json& m) { m["msg"]["header"]["frame_id"] = ""; }, "taken"},
      {"6.1", [](json& m) { m["msg"]["header"]["frame_id"] = 1; },
       "msg.header.frame_id: expected a string, got a whole number"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = "now"; },
       "msg.header.stamp: expected a number or {secs, nsecs}, got a string"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = true; },
       "msg.header.stamp: expected a number or {secs, nsecs}, got true or false"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = -0.5; },
       "msg.header.stamp: expected a finite number of at least 0, got -0.5"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = kInfinity; },
       "msg.header.stamp: expected a finite number of at least 0, got inf"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = {{"secs", 5}}; },
       "msg.header.stamp.nsecs: missing"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = {{"secs", -1}, {"nsecs", 0}}; },
       "msg.header.stamp.secs: expected a whole number from 0 to 4294967295, got -1"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = {{"secs", 5}, {"nsecs", 1'000'000'000}}; },
       "msg.header.stamp.nsecs: expected a whole number from 0 to 999999999, got 1000000000"},
      {"6.3", [](json& m) { m["msg"].erase("data"); }, "msg.data: missing"},
      {"6.3", [](json& m) { m["msg"]["compression"] = "bzip2"; },
       "msg.compression: expected \"none\" or \"gzip\", got \"bzip2\""},
      {"6.3", [](json& m) { m["msg"]["compression"] = ""; },
       "msg.compression: expected \"none\" or \"gzip\", got \"\""},
      {"6.3", [](json& m) { m["msg"]["compression"] = true; },
       "msg.compression: expected a string, got true or false"},
      {"6.3", [](json& m) { m["msg"]["compression"] = "gzip"; },
       "msg.data: expected one gzip member, got incorrect header check"},
  };
  expect_answers(rows, test::good_grid());
  expect_answers(rows, test::good_cloud());
}

TEST(ReadMapUpdate, RefusesWhatTheIcdForbidsInAGrid) {
  const IcdRow rows[] = {
      {"6.3.1", [](json& m) { m["msg"].erase("info"); }, "msg.info: missing"},
      {"6.3.1", [](json& m) { m["msg"]["info"] = 3; }, "msg.info: expected an object, got a whole number"},
      {"6.3.1", [](json& m) { m["msg"]["info"].erase("resolution"); }, "msg.info.resolution: missing"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["resolution"] = "0.2"; },
       "msg.info.resolution: expected a number, got a string"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["resolution"] = 0; },
       "msg.info.resolution: expected a number above 0, got 0"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["resolution"] = -1; },
       "msg.info.resolution: expected a number above 0, got -1"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["resolution"] = kNan; },
       "msg.info.resolution: expected a finite number, got nan"},
      {"6.3.1", [](json& m) { m["msg"]["info"].erase("width"); }, "msg.info.width: missing"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["width"] = nullptr; },
       "msg.info.width: expected a whole number, got null"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["width"] = "4"; },
       "msg.info.width: expected a whole number, got a string"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["width"] = true; },
       "msg.info.width: expected a whole number, got true or false"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["width"] = 4.5; },
       "msg.info.width: expected a whole number from 1 to 2147483647, got 4.5"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["width"] = 0; },
       "msg.info.width: expected a whole number from 1 to 2147483647, got 0"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["width"] = -4; },
       "msg.info.width: expected a whole number from 1 to 2147483647, got -4"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["width"] = 1e300; },
       "msg.info.width: expected a whole number from 1 to 2147483647, got 1e+300"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["width"] = 2147483648; },
       "msg.info.width: expected a whole number from 1 to 2147483647, got 2147483648"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["height"] = 0; },
       "msg.info.height: expected a whole number from 1 to 2147483647, got 0"},
      {"6.3.1",
       [](json& m) {
         m["msg"]["info"]["width"] = 2147483647;
         m["msg"]["info"]["height"] = 2147483647;
       },
       "msg.info.width: expected at most 268435456 cells, got 2147483647 x 2147483647 = 4611686014132420609"},
      {"6.3.1", [](json& m) { m["msg"]["info"].erase("origin"); }, "msg.info.origin: missing"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["origin"].erase("position"); },
       "msg.info.origin.position: missing"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["origin"]["position"].erase("z"); },
       "msg.info.origin.position.z: missing"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["origin"]["position"]["x"] = kInfinity; },
       "msg.info.origin.position.x: expected a finite number, got inf"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["origin"]["orientation"] = {0, 0, 0, 1}; },
       "msg.info.origin.orientation: expected an object, got an array"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["origin"]["orientation"].erase("w"); },
       "msg.info.origin.orientation.w: missing"},
      {"6.3.1", [](json& m) { m["msg"]["data"] = json::binary(Bytes(11, 0)); },
       "msg.info.width: expected 4 x 3 = 12 bytes of data, got 11"},
      {"6.3.1", [](json& m) { m["msg"]["data"] = json::binary(Bytes(13, 0)); },
       "msg.info.width: expected 4 x 3 = 12 bytes of data, got 13"},
      {"6.3.1", [](json& m) { m["msg"]["data"] = json::binary({}); },
       "msg.info.width: expected 4 x 3 = 12 bytes of data, got 0"},
      {"6.3.1", [](json& m) { m["msg"]["data"] = json::binary({0, 0, 0, 0, 0, 101, 0, 0, 0, 0, 0, 0}); },
       "msg.data[5]: expected 0 to 100 or 255, got 101"},
      {"6.3.1", [](json& m) { m["msg"]["data"] = json::binary({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 254}); },
       "msg.data[11]: expected 0 to 100 or 255, got 254"},
      {"6.3", [](json& m) { m["msg"]["data"] = {0, 1, 2, -1, 4, 5, 6, 7, 8, 9, 10, 102}; },
       "msg.data[11]: expected 0 to 100 or 255, got 102"},
      {"6.3",
       [](json& m) {
         m["msg"]["data"] = {0, 1, 2, -1, 4, 5, 6, 7, 8, 9, 10, 11};
         m["msg"]["compression"] = "gzip";
       },
       "msg.compression: expected \"none\" with data as an array, got \"gzip\""},
      {"6.3",
       [](json& m) {
         m["msg"]["data"] = json::binary(test::compressed(Bytes(11, 0)));
         m["msg"]["compression"] = "gzip";
       },
       "msg.info.width: expected 4 x 3 = 12 bytes of data, got 11"},
      {"6.3 and a gzip bomb",
       [](json& m) {
         m["msg"]["data"] = json::binary(test::compressed(Bytes(10'000'000, 0)));
         m["msg"]["compression"] = "gzip";
       },
       "msg.info.width: expected 4 x 3 = 12 bytes of data, got more"},
      {"6.3",
       [](json& m) {
         Bytes twice = test::compressed(Bytes(12, 0));
         twice.insert(twice.end(), twice.begin(), twice.end());
         m["msg"]["data"] = json::binary(twice);
         m["msg"]["compression"] = "gzip";
       },
       "msg.data: expected one gzip member and nothing after it, got 23 bytes more"},
  };
  expect_answers(rows, test::good_grid());
}

TEST(ReadMapUpdate, RefusesWhatTheIcdForbidsInACloud) {
  const IcdRow rows[] = {
      {"6.3.2", [](json& m) { m["msg"]["origin"] = 1; },
       "msg.origin: expected an object, got a whole number"},
      {"6.3.2", [](json& m) { m["msg"]["origin"]["orientation"]["w"] = nullptr; },
       "msg.origin.orientation.w: expected a number, got null"},
      {"6.3.2", [](json& m) { m["msg"].erase("fields"); }, "msg.fields: missing"},
      {"6.3.2", [](json& m) { m["msg"]["fields"] = json::object(); },
       "msg.fields: expected an array, got an object"},
      {"6.3.2", [](json& m) { m["msg"]["fields"] = json::array(); },
       "msg.fields: expected at least x, y and z, got none"},
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
      {"6.3.2", [](json& m) { m["msg"]["fields"][1]["name"] = "Y"; },
       "msg.fields: expected a field \"y\", got none"},
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
  expect_answers(rows, test::good_cloud());
}

TEST(ReadMapUpdate, RefusesACloudOverTheLargestMap) {
  icd::Rules rules;
  rules.map_bytes = 1600;
  const IcdRow rows[] = {
      {"setting", [](json& m) { m["msg"]["data"] = json::binary(Bytes(1600, 0)); }, "taken"},
      {"setting", [](json& m) { m["msg"]["data"] = json::binary(Bytes(1616, 0)); },
       "msg.data: expected at most 1600 bytes (the setting rules.map_bytes), got 1616"},
      {"setting and a gzip bomb",
       [](json& m) {
         m["msg"]["data"] = json::binary(test::compressed(Bytes(16'000'000, 0)));
         m["msg"]["compression"] = "gzip";
       },
       "msg.data: expected at most 1600 bytes, got more"},
  };
  expect_answers(rows, test::good_cloud(), rules);
}

/// Data that says at its end that it is of a wrong size.
TEST(ReadMapUpdate, KeepsNothingOfGzippedDataThatWillBeRefused) {
  constexpr std::size_t kLarge = 16'000'000, kEnoughForTheRest = 300;  // bytes; allocations
  icd::Rules rules;
  rules.map_bytes = kLarge;
  Bytes noise(kLarge + 1);
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise[i] = static_cast<std::uint8_t>((i * 2654435761u >> 13) % 101);
  json grid = test::good_grid(), cloud = test::good_cloud(), odd_cloud = cloud;
  grid["msg"]["info"]["width"] = kLarge / 4000;
  grid["msg"]["info"]["height"] = 4000;
  const auto gzipped = [&](json& map, std::size_t size) {
    map["msg"]["compression"] = "gzip";
    map["msg"]["data"] = json::binary(test::compressed(Bytes(noise.begin(), noise.begin() + size)));
  };
  gzipped(grid, kLarge - 1);
  gzipped(cloud, kLarge + 1);
  gzipped(odd_cloud, kLarge - 1);
  for (const json* const map : {&grid, &cloud, &odd_cloud}) {
    auto document = decode({.format = Format::Cbor}, Split::MapData, test::as_cbor(*map));
    ASSERT_TRUE(document);
    ScarceMemory scarce(kEnoughForTheRest, ScarceMemory::kAll);
    const auto read = read_map_update(*std::move(document), rules);
    EXPECT_EQ(scarce.end(), 0u);
    EXPECT_TRUE(test::sentence_of(read).starts_with("msg.")) << test::sentence_of(read);
  }
}

TEST(ReadMapUpdate, RefusesDataOfAnotherKind) {  // ICD 6.3 (a), (b)
  const IcdRow rows[] = {
      {"6.3", [](json& m) { m["msg"]["data"] = 5; },
       "msg.data: expected a base64 string (JSON) or a byte string (CBOR), got a whole number"},
      {"6.3", [](json& m) { m["msg"]["data"] = nullptr; },
       "msg.data: expected a base64 string (JSON) or a byte string (CBOR), got null"},
      {"6.3", [](json& m) { m["msg"]["data"] = {{"data", ""}}; },
       "msg.data: expected a base64 string (JSON) or a byte string (CBOR), got an object"},
  };
  expect_answers(rows, test::good_grid());
  expect_answers(rows, test::good_cloud());
  json base64_in_cbor = test::good_grid();
  base64_in_cbor["msg"]["data"] = "AAAAAAAAAAAAAAAA";
  EXPECT_EQ(test::sentence_of(read(Format::Cbor, test::as_cbor(base64_in_cbor))),
            "msg.data: expected a byte string, got a string");
}

TEST(ReadMapUpdate, RefusesAMemberGivenTwiceWhereTheIcdReadsIt) {
  const auto twice = [](const std::string& member, const std::string& again) {
    std::string body = test::as_json(test::good_grid());
    body.insert(body.find(member), again + ",");
    return test::sentence_of(read(Format::Json, body));
  };
  EXPECT_EQ(twice(R"("type":)", R"("type":"OccupancyGrid")"), "type: given twice");
  EXPECT_EQ(twice(R"("name":)", R"("name":"")"), "name: given twice");
  EXPECT_EQ(twice(R"("info":)", R"("info":{})"), "msg.info: given twice");
  EXPECT_EQ(twice(R"("width":)", R"("width":4)"), "msg.info.width: given twice");
  EXPECT_EQ(twice(R"("frame_id":)", R"("frame_id":"darpa")"), "msg.header.frame_id: given twice");
  EXPECT_EQ(twice(R"("compression":)", R"("compression":null)"), "msg.compression: given twice");
  EXPECT_EQ(twice(R"("w":)", R"("w":1)"), "msg.info.origin.orientation.w: given twice");
  EXPECT_EQ(twice(R"("type":)", R"("extra":1,"extra":2)"), "taken");
}

TEST(ReadMapUpdate, TakesWhatClientsSend) {
  const IcdRow rows[] = {
      {"name absent", [](json& m) { m.erase("name"); }, "taken"},
      {"name null", [](json& m) { m["name"] = nullptr; }, "taken"},
      {"name empty", [](json& m) { m["name"] = ""; }, "taken"},
      {"header absent", [](json& m) { m["msg"].erase("header"); }, "taken"},
      {"header null", [](json& m) { m["msg"]["header"] = nullptr; }, "taken"},
      {"header empty", [](json& m) { m["msg"]["header"] = json::object(); }, "taken"},
      {"stamp null", [](json& m) { m["msg"]["header"]["stamp"] = nullptr; }, "taken"},
      {"stamp a whole number", [](json& m) { m["msg"]["header"]["stamp"] = 5; }, "taken"},
      {"frame_id null", [](json& m) { m["msg"]["header"]["frame_id"] = nullptr; }, "taken"},
      {"header.seq", [](json& m) { m["msg"]["header"]["seq"] = 17; }, "taken"},
      {"compression absent", [](json& m) { m["msg"].erase("compression"); }, "taken"},
      {"compression null", [](json& m) { m["msg"]["compression"] = nullptr; }, "taken"},
      {"members of any name", [](json& m) { m["msg"]["width\n"] = {{"x", {1, "2"}}}; }, "taken"},
  };
  expect_answers(rows, test::good_grid());
  expect_answers(rows, test::good_cloud());
}

TEST(ReadMapUpdate, KeepsWhatAGridSays) {
  for (const auto format : {Format::Json, Format::Cbor}) {
    json message = test::good_grid();
    message["msg"]["info"]["width"] = 4.0;
    const auto map = read(format, format == Format::Json ? test::as_json(message) : test::as_cbor(message));
    ASSERT_TRUE(map.has_value());
    ASSERT_TRUE(map->is_grid());
    EXPECT_EQ(map->name, icd::RobotName::parse("husky_01"));
    const auto& grid = std::get<icd::OccupancyGrid>(map->msg);
    EXPECT_EQ(grid.header.stamp, 721.4);
    EXPECT_EQ(grid.resolution, 0.2);
    EXPECT_EQ(grid.width, 4U);
    EXPECT_EQ(grid.height, 3U);
    EXPECT_EQ(grid.origin, (icd::Pose{{1.5, -2.5, 0.25}, {0, 0, 0.6, 0.8}}));
    EXPECT_EQ(map->data.compression, icd::Compression::Gzip);
    EXPECT_EQ(map->data.raw_size, 12U);
    EXPECT_EQ(test::raw_data(map->data), (Bytes{0, 1, 50, 100, 255, 255, 0, 0, 100, 99, 255, 1}));
  }
}

TEST(ReadMapUpdate, KeepsWhatACloudSaysAndItsPointsAsTheyAre) {
  json message = test::good_cloud();
  message["msg"]["is_bigendian"] = 0;
  const auto map = read(Format::Json, test::as_json(message));
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

TEST(ReadMapUpdate, TakesACloudWithoutOriginByteOrderOrPoints) {
  json message = test::good_cloud();
  message["msg"].erase("origin");
  message["msg"].erase("is_bigendian");
  message["msg"]["data"] = json::binary({});
  const auto map = read(Format::Cbor, test::as_cbor(message));
  ASSERT_TRUE(map.has_value());
  EXPECT_FALSE(std::get<icd::PointCloud2>(map->msg).origin.has_value());
  EXPECT_FALSE(std::get<icd::PointCloud2>(map->msg).is_bigendian);
  EXPECT_EQ(map->data.raw_size, 0U);
}

TEST(ReadMapUpdate, MakesAnAllZeroQuaternionTheIdentity) {
  json message = test::good_grid();
  message["msg"]["info"]["origin"]["orientation"] = {{"x", 0}, {"y", 0.0}, {"z", -0.0}, {"w", 0}};
  const auto map = read(Format::Json, test::as_json(message));
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(std::get<icd::OccupancyGrid>(map->msg).origin.orientation, icd::Quaternion{});
}

TEST(ReadMapUpdate, TakesAnyFrameWhereTheSettingsRewriteIt) {
  icd::Rules rules;
  rules.rewrite_frame_id = true;
  const IcdRow rows[] = {{"6.1", [](json& m) { m["msg"]["header"]["frame_id"] = "map"; }, "taken"}};
  expect_answers(rows, test::good_grid(), rules);
}

}  // namespace
}  // namespace adit::codec
