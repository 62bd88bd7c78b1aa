// The canonical form of the mapping messages, parsed by another CBOR library.
#include <gtest/gtest.h>

#include "codec/cbor.hpp"
#include "codec/messages.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"

namespace adit::codec {
namespace {

using nlohmann::ordered_json;
using test::Bytes;

constexpr icd::Pose kPose = {{1.5, -2.5, 0.25}, {0, 0, 0.6, 0.8}};

ordered_json pose_as_json(const icd::Pose& pose) {
  return {{"position", {{"x", pose.position.x}, {"y", pose.position.y}, {"z", pose.position.z}}},
          {"orientation",
           {{"x", pose.orientation.x},
            {"y", pose.orientation.y},
            {"z", pose.orientation.z},
            {"w", pose.orientation.w}}}};
}

ordered_json read_back(const icd::ChunkedBytes& body) {
  return ordered_json::from_cbor(body.to_vector());
}

/// Compares members and their order.
void expect_alike(const ordered_json& written, const ordered_json& expected) {
  EXPECT_EQ(written, expected);
  const auto without_binary = [](ordered_json message) {
    if (message.contains("msg")) message["msg"]["data"] = nullptr;
    return message.dump();
  };
  EXPECT_EQ(without_binary(written), without_binary(expected));
}

icd::MapUpdate grid_update() {
  return {
      .name = icd::RobotName::parse("husky_01"),
      .msg =
          icd::OccupancyGrid{.header = {721.5}, .resolution = 0.2, .width = 4, .height = 1, .origin = kPose},
      .data = {.bytes = icd::ChunkedBytes(Bytes{0, 100, 255, 7}), .compression = {}, .raw_size = 4}};
}

TEST(WriteMapUpdate, WritesAGridAsTheIcdListsIt) {  // ICD 6.3.1, 6.4
  icd::MapUpdate update = grid_update();
  update.data.compression = icd::Compression::Gzip;
  const ordered_json expected = {
      {"type", "OccupancyGrid"},
      {"name", "husky_01"},
      {"msg",
       {{"header", {{"stamp", 721.5}, {"frame_id", "darpa"}}},
        {"info", {{"resolution", 0.2}, {"width", 4}, {"height", 1}, {"origin", pose_as_json(kPose)}}},
        {"data", ordered_json::binary({0, 100, 255, 7})},
        {"compression", "gzip"}}}};
  expect_alike(read_back(write_map_update(update)), expected);
}

TEST(WriteMapUpdate, WritesTheSameWithDataFirst) {
  test::Random random(1);
  for (int i = 0; i < 100; ++i) {
    const icd::MapUpdate update = i % 2 == 0 ? test::random_grid(random) : test::random_cloud(random);
    const DataFirst written = write_data_first(update);
    EXPECT_EQ(written.before.size(), DataFirst::kBefore);
    const std::string message = written.before + update.data.bytes.to_string() +
                                written.after.substr(0, written.after.size() - DataFirst::kChecksum);
    EXPECT_EQ(nlohmann::json::from_cbor(message),
              nlohmann::json::from_cbor(write_map_update(update).to_vector()));
    auto document = decode({Format::Cbor, ContentCoding::Identity}, Split::MapData, message);
    ASSERT_TRUE(document) << document.error().sentence;
    const auto read = read_map_update(std::move(*document), {});
    ASSERT_TRUE(read) << read.error().sentence;
    test::expect_same(*read, test::little_endian(update));
    if (!update.is_grid() && update.data.compression != icd::Compression::None)
      continue;  // stored in another form
    EXPECT_EQ(data_after(written.before), update.data.bytes.size());
    EXPECT_EQ(read_data_first(written.before, update.data.bytes, written.after, {}), update);
    for (std::string damaged = written.after; !damaged.empty(); damaged.pop_back()) {
      damaged.back() ^= 1;
      EXPECT_FALSE(read_data_first(written.before, update.data.bytes, damaged, {})) << damaged.size();
      damaged.back() ^= 1;
    }
    EXPECT_TRUE(check_data(update));
  }
}

TEST(WriteMapUpdate, WritesACloudAsTheIcdListsIt) {  // ICD 6.3.2, 6.4
  const icd::MapUpdate update{.name = std::nullopt,
                              .msg = icd::PointCloud2{.header = {},
                                                      .origin = {},
                                                      .fields = {{"x", 0, icd::Datatype::Float32, 1},
                                                                 {"y", 4, icd::Datatype::Float32, 1},
                                                                 {"z", 8, icd::Datatype::Float32, 1},
                                                                 {"ring", 65000, icd::Datatype::Uint16, 3}},
                                                      .is_bigendian = true,
                                                      .point_step = 65536},
                              .data = {.bytes = {}, .compression = icd::Compression::None, .raw_size = 0}};
  const auto field = [](const char* name, int offset, int datatype, int count) {
    return ordered_json{{"name", name}, {"offset", offset}, {"datatype", datatype}, {"count", count}};
  };
  const ordered_json expected = {
      {"type", "PointCloud2"},
      {"name", ""},
      {"msg",
       {{"header", {{"frame_id", "darpa"}}},
        {"fields",
         {field("x", 0, 7, 1), field("y", 4, 7, 1), field("z", 8, 7, 1), field("ring", 65000, 4, 3)}},
        {"is_bigendian", true},
        {"point_step", 65536},
        {"data", ordered_json::binary({})},
        {"compression", "none"}}}};
  expect_alike(read_back(write_map_update(update)), expected);
}

TEST(WriteMapUpdate, SharesTheChunksOfTheData) {
  icd::MapUpdate update = grid_update();
  update.data.bytes = icd::ChunkedBytes(Bytes(300'000, 1));
  const icd::ChunkedBytes body = write_map_update(update);
  std::size_t shared = 0;
  for (const auto& chunk : body.chunks()) {
    for (const auto& ours : update.data.bytes.chunks())
      shared += chunk->data() == ours->data() ? chunk->size() : 0;
  }
  EXPECT_EQ(shared, 300'000U);
}

TEST(WriteStateUpdate, WritesAllAsTheIcdListsIt) {  // ICD 6.5
  const icd::StateUpdate update{
      .header = {7.0}, .poses = {{*icd::RobotName::parse("a"), kPose}, {*icd::RobotName::parse("b"), {}}}};
  const auto named = [](const char* name, const icd::Pose& pose) {
    ordered_json one = {{"name", name}};
    one.update(pose_as_json(pose));
    return one;
  };
  const ordered_json expected = {{"header", {{"stamp", 7.0}, {"frame_id", "darpa"}}},
                                 {"poses", {named("a", kPose), named("b", {})}}};
  expect_alike(read_back(write_state_update(update)), expected);
  expect_alike(read_back(write_state_update({})),
               {{"header", {{"frame_id", "darpa"}}}, {"poses", ordered_json::array()}});
}

TEST(WriteMarkersUpdate, WritesAllAsTheIcdListsIt) {  // ICD 6.6
  icd::Marker delete_all;
  delete_all.action = icd::MarkerAction::DeleteAll;
  const icd::MarkersUpdate update{{{.header = {1.0},
                                    .ns = "n",
                                    .id = -2147483647 - 1,
                                    .type = 9,
                                    .action = icd::MarkerAction::Add,
                                    .pose = kPose,
                                    .scale = {1, 2, 3},
                                    .color = {0, 0.25, 0.5, 1},
                                    .lifetime = 10,
                                    .text = "Fire \xf0\x9f\x94\xa5"},
                                   delete_all}};
  const auto marker = [](ordered_json header, const char* ns, std::int32_t id, int type, int action,
                         const icd::Pose& pose, ordered_json scale, ordered_json color, double lifetime,
                         const char* text) {
    return ordered_json{{"header", std::move(header)},
                        {"ns", ns},
                        {"id", id},
                        {"type", type},
                        {"action", action},
                        {"pose", pose_as_json(pose)},
                        {"scale", std::move(scale)},
                        {"color", std::move(color)},
                        {"lifetime", lifetime},
                        {"text", text}};
  };
  const ordered_json expected = {
      {"markers",
       {marker({{"stamp", 1.0}, {"frame_id", "darpa"}}, "n", -2147483647 - 1, 9, 0, kPose,
               {{"x", 1.0}, {"y", 2.0}, {"z", 3.0}}, {{"r", 0.0}, {"g", 0.25}, {"b", 0.5}, {"a", 1.0}}, 10.0,
               "Fire \xf0\x9f\x94\xa5"),
        marker({{"frame_id", "darpa"}}, "", 0, 0, 3, {}, {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}},
               {{"r", 0.0}, {"g", 0.0}, {"b", 0.0}, {"a", 0.0}}, 0.0, "")}}};
  expect_alike(read_back(write_markers_update(update)), expected);
}

TEST(CborWriter, WritesTheShortestHead) {  // RFC 8949 4.1, appendix A
  const auto written = [](std::int64_t number) {
    CborWriter out;
    out.integer(number);
    return out.finish().to_vector();
  };
  EXPECT_EQ(written(0), (Bytes{0x00}));
  EXPECT_EQ(written(23), (Bytes{0x17}));
  EXPECT_EQ(written(24), (Bytes{0x18, 24}));
  EXPECT_EQ(written(1000), (Bytes{0x19, 0x03, 0xe8}));
  EXPECT_EQ(written(1000000), (Bytes{0x1a, 0x00, 0x0f, 0x42, 0x40}));
  EXPECT_EQ(written(1000000000000), (Bytes{0x1b, 0x00, 0x00, 0x00, 0xe8, 0xd4, 0xa5, 0x10, 0x00}));
  EXPECT_EQ(written(-1), (Bytes{0x20}));
  EXPECT_EQ(written(-100), (Bytes{0x38, 99}));
  EXPECT_EQ(written(-1000), (Bytes{0x39, 0x03, 0xe7}));
}

TEST(CborWriter, WritesRealNumbersAsDoubles) {
  CborWriter out;
  out.floating(1);
  EXPECT_EQ(out.finish().to_vector(), (Bytes{0xfb, 0x3f, 0xf0, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace adit::codec
