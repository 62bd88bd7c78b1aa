// Adit sends big-endian clouds (ICD 6.3.2) as little-endian, value by value.
#include <gtest/gtest.h>

#include <cstring>

#include "codec/messages.hpp"
#include "codec/read.hpp"

namespace adit::codec {
namespace {

using test::Bytes;
using test::json;

struct FieldRow {
  const char* name;
  int offset, datatype, count;
};

json big_endian_cloud(std::span<const FieldRow> rows, int point_step, const Bytes& data) {
  json message = test::good_cloud();
  json fields = json::array();
  for (const FieldRow& row : rows) {
    fields.push_back(
        {{"name", row.name}, {"offset", row.offset}, {"datatype", row.datatype}, {"count", row.count}});
  }
  message["msg"]["fields"] = fields;
  message["msg"]["point_step"] = point_step;
  message["msg"]["is_bigendian"] = true;
  message["msg"]["data"] = json::binary(data);
  message["msg"].erase("origin");
  return message;
}

icd::Checked<icd::MapUpdate> read(const json& message) {
  auto document = decode({.format = Format::Cbor}, Split::MapData, test::as_cbor(message));
  if (!document) return std::unexpected(document.error());
  return read_map_update(*std::move(document), {});
}

const icd::PointCloud2& cloud_in(const icd::MapUpdate& map) {
  return std::get<icd::PointCloud2>(map.msg);
}

constexpr FieldRow kFloats[] = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}};

TEST(BigEndianCloud, BecomesTheSameLittleEndianCloud) {
  constexpr FieldRow rows[] = {{"x", 1, 8, 1},    {"y", 9, 8, 1},      {"z", 17, 8, 1},
                               {"flag", 0, 2, 1}, {"ring", 26, 4, 2},  {"signed", 30, 5, 1},
                               {"tag", 34, 1, 3}, {"double", 38, 8, 1}};
  Bytes point(48), turned(48);
  for (std::size_t i = 0; i < point.size(); ++i) point[i] = turned[i] = static_cast<std::uint8_t>(i);
  for (const auto& [begin, size] : {std::pair{1, 8}, {9, 8}, {17, 8}, {26, 2}, {28, 2}, {30, 4}, {38, 8}}) {
    for (int i = 0; i < size; ++i) turned[begin + i] = static_cast<std::uint8_t>(begin + size - 1 - i);
  }
  // More points than one chunk has; a chunk does not end at a point.
  Bytes all, all_turned;
  for (int i = 0; i < 10'000; ++i) {
    point[47] = turned[47] = static_cast<std::uint8_t>(i);  // padding
    all.insert(all.end(), point.begin(), point.end());
    all_turned.insert(all_turned.end(), turned.begin(), turned.end());
  }
  const auto map = read(big_endian_cloud(rows, 48, all));
  ASSERT_TRUE(map) << map.error().sentence;
  EXPECT_FALSE(cloud_in(*map).is_bigendian);
  EXPECT_FALSE(cloud_in(*map).origin.has_value());
  EXPECT_EQ(map->data.raw_size, all.size());
  EXPECT_EQ(test::raw_data(map->data), all_turned);
}

TEST(BigEndianCloud, HasTheFloatsOfItsSender) {
  const float sent[] = {1.5F, -20.25F, 3e8F};
  Bytes data;
  for (const float value : sent) {
    Bytes bytes(sizeof value);
    std::memcpy(bytes.data(), &value, sizeof value);
    data.insert(data.end(), bytes.rbegin(), bytes.rend());  // this machine is little-endian
  }
  json message = big_endian_cloud(kFloats, 12, data);
  message["msg"]["data"] = json::binary(test::compressed(data));
  message["msg"]["compression"] = "gzip";
  const auto map = read(message);
  ASSERT_TRUE(map) << map.error().sentence;
  float got[3];
  const Bytes points = test::raw_data(map->data);
  ASSERT_EQ(points.size(), sizeof got);
  std::memcpy(got, points.data(), sizeof got);
  EXPECT_EQ(0, std::memcmp(got, sent, sizeof got));
}

TEST(BigEndianCloud, MayGiveOneValueTwoNames) {
  constexpr FieldRow rows[] = {
      {"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}, {"rgb", 12, 7, 1}, {"rgba", 12, 6, 1}};
  const auto map =
      read(big_endian_cloud(rows, 16, Bytes{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}));
  ASSERT_TRUE(map) << map.error().sentence;
  EXPECT_FALSE(cloud_in(*map).is_bigendian);
  EXPECT_EQ(test::raw_data(map->data), (Bytes{3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12}));
}

TEST(BigEndianCloud, StaysBigEndianIfFieldsOverlap) {
  constexpr FieldRow rows[] = {
      {"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}, {"rgb", 12, 7, 1}, {"red", 13, 2, 1}};
  const Bytes data(32, 0x41);
  json message = big_endian_cloud(rows, 16, data);
  const auto map = read(message);
  ASSERT_TRUE(map) << map.error().sentence;
  EXPECT_TRUE(cloud_in(*map).is_bigendian);
  EXPECT_EQ(test::raw_data(map->data), data);

  message["msg"]["origin"] = test::good_cloud()["msg"]["origin"];  // a server exists that converts it wrongly
  EXPECT_EQ(
      test::sentence_of(read(message)),
      "msg.is_bigendian: expected false for a cloud that has an origin and overlapping fields, got true");
}

TEST(BigEndianCloud, IsRejectedWithAPartialPoint) {
  EXPECT_EQ(test::sentence_of(read(big_endian_cloud(kFloats, 12, Bytes(13)))),
            "msg.data: expected a multiple of point_step 12, got 13 bytes");
}

}  // namespace
}  // namespace adit::codec
