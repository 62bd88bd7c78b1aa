// A row for each rule of the ICD about an OccupancyGrid in POST /map/update, sent as JSON and as CBOR.
#include <gtest/gtest.h>

#include "codec/read_map.hpp"

namespace adit::codec {
namespace {

using test::Bytes;
using test::expect_map_answers;
using test::IcdRow;
using test::json;
using test::kInfinity;
using test::kNan;
using test::read_map;

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
  expect_map_answers(rows, test::good_grid());
}

TEST(ReadMapUpdate, KeepsWhatAGridSays) {
  for (const auto format : {Format::Json, Format::Cbor}) {
    json message = test::good_grid();
    message["msg"]["info"]["width"] = 4.0;
    const auto map =
        read_map(format, format == Format::Json ? test::as_json(message) : test::as_cbor(message));
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

TEST(ReadMapUpdate, MakesAnAllZeroQuaternionTheIdentity) {
  json message = test::good_grid();
  message["msg"]["info"]["origin"]["orientation"] = {{"x", 0}, {"y", 0.0}, {"z", -0.0}, {"w", 0}};
  const auto map = read_map(Format::Json, test::as_json(message));
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(std::get<icd::OccupancyGrid>(map->msg).origin.orientation, icd::Quaternion{});
}

}  // namespace
}  // namespace adit::codec
