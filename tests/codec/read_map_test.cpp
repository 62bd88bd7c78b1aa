// One row for each rule of the ICD about any map in POST /map/update, sent as JSON and as CBOR.
#include "codec/read_map.hpp"

#include <gtest/gtest.h>

#include "scarce_memory.hpp"

namespace adit::codec {
namespace {

using test::Bytes;
using test::expect_map_answers;
using test::IcdRow;
using test::json;
using test::kInfinity;
using test::read_map;

TEST(ReadMapUpdate, RejectsAForbiddenMap) {
  const IcdRow rows[] = {
      {"6.4", [](json&) {}, "accepted"},
      {"6.4", [](json& m) { m = json::array(); }, "the body: expected an object, got an array"},
      {"6.4", [](json& m) { m = "map"; }, "the body: expected an object, got a string"},
      {"6.4", [](json& m) { m.erase("type"); }, "type: missing"},
      {"6.4", [](json& m) { m["type"] = 1; }, "type: expected a string, got a whole number"},
      {"6.4", [](json& m) { m["type"] = "occupancygrid"; },
       "type: expected \"OccupancyGrid\" or \"PointCloud2\", got \"occupancygrid\""},
      {"6.4", [](json& m) { m["type"] = ""; },
       "type: expected \"OccupancyGrid\" or \"PointCloud2\", got \"\""},
      {"6.4", [](json& m) { m.erase("msg"); }, "msg: missing"},
      {"6.4", [](json& m) { m.erase("type"), m.erase("msg"); }, "type, msg: missing"},
      {"6.4", [](json& m) { m["msg"] = nullptr; }, "msg: expected an object, got null"},
      {"6.4", [](json& m) { m["msg"] = {1}; }, "msg: expected an object, got an array"},
      {"2, 6.4", [](json& m) { m["name"] = "ABCDEFGHIJK"; },
       "name: expected 1 to 10 letters, digits and underscores, got \"ABCDEFGHIJK\" (the setting "
       "robots[].alias can map this name to a valid one)"},
      {"2, 6.4", [](json& m) { m["name"] = "a-b"; },
       "name: expected 1 to 10 letters, digits and underscores, got \"a-b\" (the setting robots[].alias can "
       "map this name to a valid one)"},
      {"2, 6.4", [](json& m) { m["name"] = 7; }, "name: expected a string, got a whole number"},
      {"2, 6.4", [](json& m) { m["name"] = std::string("a\0b", 3); },
       "name: expected a string without NUL characters, got one with them"},
      {"6.3.1", [](json& m) { m["msg"]["header"] = 5; },
       "msg.header: expected an object, got a whole number"},
      {"6.1", [](json& m) { m["msg"]["header"]["frame_id"] = "map"; },
       "msg.header.frame_id: expected \"darpa\", got \"map\" (the setting rules.rewrite_frame_id accepts any "
       "frame)"},
      {"6.1", [](json& m) { m["msg"]["header"]["frame_id"] = ""; }, "accepted"},
      {"6.1", [](json& m) { m["msg"]["header"]["frame_id"] = 1; },
       "msg.header.frame_id: expected a string, got a whole number"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = "now"; },
       "msg.header.stamp: expected a number, {secs, nsecs}, {sec, nanosec} or {sec, nsec}, got a string"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = true; },
       "msg.header.stamp: expected a number, {secs, nsecs}, {sec, nanosec} or {sec, nsec}, got true or "
       "false"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = -0.5; },
       "msg.header.stamp: expected a number from 0 to 4294967295.9999995, got -0.5"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = kInfinity; },
       "msg.header.stamp: expected a number from 0 to 4294967295.9999995, got inf"},
      {"6.2 and ROS's time", [](json& m) { m["msg"]["header"]["stamp"] = 4294967295.5; }, "accepted"},
      {"6.2 and ROS's time", [](json& m) { m["msg"]["header"]["stamp"] = 4294967296.0; },
       "msg.header.stamp: expected a number from 0 to 4294967295.9999995, got 4294967296"},
      {"6.2 in other units", [](json& m) { m["msg"]["header"]["stamp"] = 1'700'000'000'123; },
       "msg.header.stamp: expected a number from 0 to 4294967295.9999995, got 1700000000123 (this looks like "
       "milliseconds: divide by 1,000)"},
      {"6.2 in other units", [](json& m) { m["msg"]["header"]["stamp"] = 1'700'000'000'123'456; },
       "msg.header.stamp: expected a number from 0 to 4294967295.9999995, got 1700000000123456 (this looks "
       "like microseconds: divide by 1,000,000)"},
      {"6.2 in other units", [](json& m) { m["msg"]["header"]["stamp"] = 1'700'000'000'123'456'789; },
       "msg.header.stamp: expected a number from 0 to 4294967295.9999995, got 1700000000123456768 (this "
       "looks like nanoseconds: divide by 1,000,000,000)"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = {{"secs", 5}}; },
       "msg.header.stamp.nsecs: missing"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = {{"secs", -1}, {"nsecs", 0}}; },
       "msg.header.stamp.secs: expected a whole number from 0 to 4294967295, got -1"},
      {"6.2", [](json& m) { m["msg"]["header"]["stamp"] = {{"secs", 5}, {"nsecs", 1'000'000'000}}; },
       "msg.header.stamp.nsecs: expected a whole number from 0 to 999999999, got 1000000000"},
      {"6.2 and ROS 2", [](json& m) { m["msg"]["header"]["stamp"] = {{"sec", 5}, {"nanosec", 7}}; },
       "accepted"},
      {"6.2 and ROS's C++", [](json& m) { m["msg"]["header"]["stamp"] = {{"sec", 5}, {"nsec", 7}}; },
       "accepted"},
      {"6.2 and ROS 2", [](json& m) { m["msg"]["header"]["stamp"] = {{"sec", 5}}; },
       "msg.header.stamp.nanosec: missing"},
      {"6.2 and ROS 2", [](json& m) { m["msg"]["header"]["stamp"] = {{"secs", 5}, {"nanosec", 7}}; },
       "msg.header.stamp.sec: missing"},
      {"6.2 and ROS 2", [](json& m) { m["msg"]["header"]["stamp"] = {{"sec", -1}, {"nanosec", 0}}; },
       "msg.header.stamp.sec: expected a whole number from 0 to 4294967295, got -1"},
      {"6.2 and ROS 2",
       [](json& m) { m["msg"]["header"]["stamp"] = {{"sec", 5}, {"nanosec", 1}, {"nsec", 2}}; },
       "msg.header.stamp: expected one of {secs, nsecs}, {sec, nanosec} or {sec, nsec}, got members of two"},
      {"6.2 and ROS 2",
       [](json& m) { m["msg"]["header"]["stamp"] = {{"sec", 5}, {"secs", 6}, {"nsecs", 2}}; },
       "msg.header.stamp: expected one of {secs, nsecs}, {sec, nanosec} or {sec, nsec}, got members of two"},
      {"6.3", [](json& m) { m["msg"].erase("data"); }, "msg.data: missing"},
      {"6.3", [](json& m) { m["msg"]["compression"] = "bzip2"; },
       "msg.compression: expected \"none\" or \"gzip\", got \"bzip2\""},
      {"6.3", [](json& m) { m["msg"]["compression"] = ""; },
       "msg.compression: expected \"none\" or \"gzip\", got \"\""},
      {"6.3", [](json& m) { m["msg"]["compression"] = true; },
       "msg.compression: expected a string, got true or false"},
      {"6.3", [](json& m) { m["msg"]["compression"] = "NONE"; }, "accepted"},
      {"6.3", [](json& m) { m["msg"]["compression"] = "gzi"; },
       "msg.compression: expected \"none\" or \"gzip\", got \"gzi\""},
      {"6.3", [](json& m) { m["msg"]["compression"] = "GZip"; },
       "msg.data: expected a gzip member, got incorrect header check"},
      {"6.3", [](json& m) { m["msg"]["compression"] = "gzip"; },
       "msg.data: expected a gzip member, got incorrect header check"},
  };
  expect_map_answers(rows, test::good_grid());
  expect_map_answers(rows, test::good_cloud());
}

TEST(ReadMapUpdate, RejectsDataOverTheLargestMapWith413) {
  icd::Rules rules;
  rules.map_bytes = 1600;
  const Bytes data(rules.map_bytes + 16, 0);
  Bytes members = test::compressed(Bytes(rules.map_bytes, 0));
  const Bytes last = test::compressed(Bytes(16, 0));
  members.insert(members.end(), last.begin(), last.end());
  json grid = test::good_grid();
  grid["msg"]["info"]["width"] = data.size();
  grid["msg"]["info"]["height"] = 1;
  for (json map : {grid, test::good_cloud()}) {
    for (const json& form :
         {json::binary(data), json(data), json::binary(test::compressed(data)), json::binary(members)}) {
      map["msg"]["data"] = form;
      map["msg"]["compression"] =
          form.is_binary() && form.get_binary().size() < data.size() ? "gzip" : "none";
      for (const auto format : {Format::Json, Format::Cbor}) {
        auto document = decode({.format = format}, Split::MapData,
                               format == Format::Json ? test::as_json(map) : test::as_cbor(map),
                               {.data_bytes = rules.map_bytes});
        const auto refused =
            document ? read_map_update(*std::move(document), rules).error() : document.error();
        EXPECT_EQ(refused.status, icd::Status::ContentTooLarge) << refused.sentence;
      }
    }
  }
}

/// The data has a wrong size, which only its end shows.
TEST(ReadMapUpdate, AllocatesLittleForRejectedGzippedData) {
  constexpr std::size_t kLarge = 4'000'000, kEnoughForTheRest = 300;  // bytes; allocations
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
    ASSERT_FALSE(read);
    EXPECT_TRUE(read.error().sentence.starts_with("msg.")) << read.error().sentence;
  }
}

TEST(ReadMapUpdate, RejectsDataOfAnotherKind) {  // ICD 6.3 (a), (b)
  const IcdRow rows[] = {
      {"6.3", [](json& m) { m["msg"]["data"] = 5; },
       "msg.data: expected a base64 string (JSON) or a byte string (CBOR), got a whole number"},
      {"6.3", [](json& m) { m["msg"]["data"] = nullptr; },
       "msg.data: expected a base64 string (JSON) or a byte string (CBOR), got null"},
      {"6.3", [](json& m) { m["msg"]["data"] = {{"data", ""}}; },
       "msg.data: expected a base64 string (JSON) or a byte string (CBOR), got an object"},
  };
  expect_map_answers(rows, test::good_grid());
  expect_map_answers(rows, test::good_cloud());
  json base64_in_cbor = test::good_grid();
  base64_in_cbor["msg"]["data"] = "AAAAAAAAAAAAAAAA";
  EXPECT_EQ(test::sentence_of(read_map(Format::Cbor, test::as_cbor(base64_in_cbor))),
            "msg.data: expected a byte string, got a string");
}

TEST(ReadMapUpdate, RejectsAMemberOfTheIcdGivenTwice) {
  const auto twice = [](const std::string& member, const std::string& again) {
    std::string body = test::as_json(test::good_grid());
    body.insert(body.find(member), again + ",");
    return test::sentence_of(read_map(Format::Json, body));
  };
  EXPECT_EQ(twice(R"("type":)", R"("type":"OccupancyGrid")"), "type: given twice");
  EXPECT_EQ(twice(R"("name":)", R"("name":"")"), "name: given twice");
  EXPECT_EQ(twice(R"("info":)", R"("info":{})"), "msg.info: given twice");
  EXPECT_EQ(twice(R"("width":)", R"("width":4)"), "msg.info.width: given twice");
  EXPECT_EQ(twice(R"("frame_id":)", R"("frame_id":"darpa")"), "msg.header.frame_id: given twice");
  EXPECT_EQ(twice(R"("compression":)", R"("compression":null)"), "msg.compression: given twice");
  EXPECT_EQ(twice(R"("w":)", R"("w":1)"), "msg.info.origin.orientation.w: given twice");
  EXPECT_EQ(twice(R"("type":)", R"("extra":1,"extra":2)"), "accepted");
}

TEST(ReadMapUpdate, AcceptsMessagesOfRealClients) {
  const IcdRow rows[] = {
      {"name absent", [](json& m) { m.erase("name"); }, "accepted"},
      {"name null", [](json& m) { m["name"] = nullptr; }, "accepted"},
      {"name empty", [](json& m) { m["name"] = ""; }, "accepted"},
      {"header absent", [](json& m) { m["msg"].erase("header"); }, "accepted"},
      {"header null", [](json& m) { m["msg"]["header"] = nullptr; }, "accepted"},
      {"header empty", [](json& m) { m["msg"]["header"] = json::object(); }, "accepted"},
      {"stamp null", [](json& m) { m["msg"]["header"]["stamp"] = nullptr; }, "accepted"},
      {"stamp a whole number", [](json& m) { m["msg"]["header"]["stamp"] = 5; }, "accepted"},
      {"frame_id null", [](json& m) { m["msg"]["header"]["frame_id"] = nullptr; }, "accepted"},
      {"header.seq", [](json& m) { m["msg"]["header"]["seq"] = 17; }, "accepted"},
      {"compression absent", [](json& m) { m["msg"].erase("compression"); }, "accepted"},
      {"compression null", [](json& m) { m["msg"]["compression"] = nullptr; }, "accepted"},
      {"members of any name", [](json& m) { m["msg"]["width\n"] = {{"x", {1, "2"}}}; }, "accepted"},
  };
  expect_map_answers(rows, test::good_grid());
  expect_map_answers(rows, test::good_cloud());
}

TEST(ReadMapUpdate, AcceptsAnyFrameIfTheSettingsRewriteIt) {
  icd::Rules rules;
  rules.rewrite_frame_id = true;
  const IcdRow rows[] = {{"6.1", [](json& m) { m["msg"]["header"]["frame_id"] = "map"; }, "accepted"}};
  expect_map_answers(rows, test::good_grid(), rules);
}

}  // namespace
}  // namespace adit::codec
