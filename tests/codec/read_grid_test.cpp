// One row for each rule of the ICD about an OccupancyGrid in POST /map/update, sent as JSON and as CBOR.
#include <gtest/gtest.h>
#include <zlib.h>

#include "codec/gzip.hpp"
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

Bytes members_of(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) {
    const Bytes member = test::compressed(part);
    all.insert(all.end(), member.begin(), member.end());
  }
  return all;
}

TEST(ReadMapUpdate, RejectsAForbiddenGrid) {
  const IcdRow rows[] = {
      {"6.4", [](json& m) { m = m["msg"]; },
       "type, msg: missing (found info: put header, info and data into msg)"},
      {"6.4", [](json& m) { m["msg"].erase("info"), m["msg"].erase("data"), m["msg"].erase("header"); },
       "msg.info, msg.data: missing"},
      {"6.3.1", [](json& m) { m["msg"].erase("info"); }, "msg.info: missing"},
      {"6.3.1", [](json& m) { m["msg"]["info"] = 3; }, "msg.info: expected an object, got a whole number"},
      {"6.3.1", [](json& m) { m["msg"]["info"].erase("resolution"); }, "msg.info.resolution: missing"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["resolution"] = "0.2"; },
       "msg.info.resolution: expected a number, got a string"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["resolution"] = 0; },
       "msg.info.resolution: expected a finite float32 above 0, got 0"},
      {"6.3.1", [](json& m) { m["msg"]["info"]["resolution"] = -1; },
       "msg.info.resolution: expected a finite float32 above 0, got -1"},
      {"6.3.1 and ROS's float32", [](json& m) { m["msg"]["info"]["resolution"] = 1e39; },
       "msg.info.resolution: expected a finite float32 above 0, got 1e+39"},
      {"6.3.1 and ROS's float32", [](json& m) { m["msg"]["info"]["resolution"] = 1e-50; },
       "msg.info.resolution: expected a finite float32 above 0, got 1e-50"},
      {"6.3.1 and ROS's float32", [](json& m) { m["msg"]["info"]["resolution"] = 3.4e38; }, "accepted"},
      {"6.3.1 and ROS's float32", [](json& m) { m["msg"]["info"]["resolution"] = 2e-45; }, "accepted"},
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
       "413: msg.info.width: expected at most 268435456 cells, got 2147483647 x 2147483647 = "
       "4611686014132420609"},
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
      {"6.3.1",
       [](json& m) { m["msg"]["info"]["origin"]["orientation"] = test::quaternion(5e-324, 0, 0, 0); },
       "msg.info.origin.orientation: expected a quaternion of length 1, got one too short to have a "
       "direction"},
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
         m["msg"]["data"] = json::binary(members_of({Bytes(5, 0), Bytes(6, 0)}));
         m["msg"]["compression"] = "gzip";
       },
       "msg.info.width: expected 4 x 3 = 12 bytes of data, got 11"},
      {"6.3 and its last member alone as large as it should be",
       [](json& m) {
         m["msg"]["data"] = json::binary(members_of({Bytes(1, 0), Bytes(12, 0)}));
         m["msg"]["compression"] = "gzip";
       },
       "msg.info.width: expected 4 x 3 = 12 bytes of data, got more"},
  };
  expect_map_answers(rows, test::good_grid());
}

TEST(ReadMapUpdate, KeepsTheMembersOfAGrid) {
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

/// Patterns that repeat at a distance, which Z_RLE does not find.
Bytes patterned(std::size_t size) {
  Bytes cells(size);
  for (std::size_t i = 0; i < size; ++i) cells[i] = static_cast<std::uint8_t>(i % 700 % 97);
  return cells;
}

/// The data that the codec stores for `member`, which contains `cells`.
icd::ChunkedBytes kept_of(const Bytes& member, const Bytes& cells) {
  json message = test::good_grid();
  message["msg"]["info"]["width"] = cells.size();
  message["msg"]["info"]["height"] = 1;
  message["msg"]["compression"] = "gzip";
  message["msg"]["data"] = json::binary(member);
  const auto map = read_map(Format::Cbor, test::as_cbor(message));
  EXPECT_EQ(test::sentence_of(map), "accepted");
  EXPECT_EQ(map->data.compression, icd::Compression::Gzip);
  EXPECT_EQ(map->data.raw_size, cells.size());
  EXPECT_EQ(test::only_member(map->data.bytes.to_vector()), cells);
  return map->data.bytes;
}

TEST(ReadMapUpdate, KeepsTheSendersGzipMemberIfSmaller) {
  const Bytes cells = patterned(50'000), member = test::compressed(cells);
  EXPECT_EQ(kept_of(member, cells), icd::ChunkedBytes(member));
}

/// Bytes after a gzip member hang a Command Post.
TEST(ReadMapUpdate, UsesItsOwnGzipMemberIfTheSenderHasSeveral) {
  const Bytes cells = patterned(50'000), half(cells.begin(), cells.begin() + 25'000),
              rest(cells.begin() + 25'000, cells.end());
  for (const Bytes& members : {members_of({half, rest}), members_of({{}, cells}), members_of({cells, {}}),
                               members_of({{}, half, {}, rest})}) {
    EXPECT_EQ(kept_of(members, cells), gzip(icd::ChunkedBytes(cells), GzipStrategy::Runs));
  }
}

TEST(ReadMapUpdate, UsesItsOwnGzipMemberIfSmaller) {
  Bytes cells(50'000, icd::kUnknownCell);
  for (std::size_t i = 0; i < cells.size(); i += 4'000) cells[i] = 100;
  Bytes stored{0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255};  // one stored block (RFC 1951 3.2.4)
  const auto put = [&](std::size_t number, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) stored.push_back(static_cast<std::uint8_t>(number >> 8 * i));
  };
  put(1, 1);
  put(cells.size(), 2);
  put(~cells.size(), 2);
  stored.insert(stored.end(), cells.begin(), cells.end());
  put(crc32(0, cells.data(), static_cast<uInt>(cells.size())), 4);
  put(cells.size(), 4);
  EXPECT_EQ(kept_of(stored, cells), gzip(icd::ChunkedBytes(cells), GzipStrategy::Runs));
}

TEST(ReadMapUpdate, KeepsNoGzipMemberWithAFileName) {
  const Bytes cells = patterned(50'000), plain = test::compressed(cells);
  Bytes named = plain;
  constexpr std::uint8_t kName = 8;  // RFC 1952 2.3.1
  named[3] = kName;
  const Bytes name{'m', 'a', 'p', 0};
  named.insert(named.begin() + 10, name.begin(), name.end());
  const auto kept = kept_of(named, cells);
  EXPECT_EQ(kept, gzip(icd::ChunkedBytes(cells), GzipStrategy::Runs));
  EXPECT_GT(kept.size(), named.size());
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
