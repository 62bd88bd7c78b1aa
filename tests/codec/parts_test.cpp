// One bad pose or marker does not affect the others. Text that Python 2 writes in CBOR counts as text.
#include <gtest/gtest.h>

#include "codec/messages.hpp"
#include "codec/read.hpp"

namespace adit::codec {
namespace {

using test::json;

json state_of(int poses) {
  json message = test::good_state();
  json poses_list = json::array();
  for (int i = 0; i < poses; ++i) {
    poses_list.push_back(message["poses"][0]);
    poses_list.back()["name"] = "r" + std::to_string(i);
  }
  message["poses"] = poses_list;
  return message;
}

template <class Message>
using PartsReader = icd::Checked<CheckedParts<Message>> (*)(const Document&, const icd::Rules&);

template <class Message>
icd::Checked<CheckedParts<Message>> read(PartsReader<Message> reader, const json& message) {
  const auto document = decode({.format = Format::Json}, Split::Nothing, test::as_json(message));
  if (!document) return std::unexpected(document.error());
  return reader(*document, {});
}

std::string names_of(const icd::StateUpdate& update) {
  std::string names;
  for (const icd::NamedPose& named : update.poses) names += named.name.text() + " ";
  return names;
}

TEST(StateParts, HaveTheGoodPosesAndASentenceForEachBadOne) {
  json message = state_of(4);
  message["poses"][1].erase("name");
  message["poses"][2]["position"]["x"] = "far";
  const auto read_parts = read(read_state_parts, message);
  ASSERT_TRUE(read_parts);
  EXPECT_EQ(read_parts->message.header.stamp, 721.4);
  EXPECT_EQ(names_of(read_parts->message), "r0 r3 ");
  EXPECT_EQ(read_parts->refused.count, 2U);
  const icd::Refusal refusal = read_parts->refused.refusal();
  EXPECT_EQ(refusal.status, icd::Status::UnprocessableEntity);
  EXPECT_EQ(refusal.sentence,
            "poses[1].name: missing; poses[2].position.x: expected a number, got a string (the other 2 were "
            "accepted)");
}

TEST(StateParts, HaveAllPosesIfAllAreGood) {
  const auto read_parts = read(read_state_parts, state_of(3));
  ASSERT_TRUE(read_parts);
  EXPECT_EQ(read_parts->refused.count, 0U);
  EXPECT_TRUE(read(read_state_parts, state_of(0)));
}

TEST(StateParts, ListTenBadPosesAndCountTheRest) {
  json message = state_of(30);
  for (int i = 1; i < 30; ++i) message["poses"][i]["name"] = 7;
  EXPECT_EQ(read(read_state_parts, message)->refused.refusal().parts,
            read(read_state_parts, message)->refused.count);
  const std::string sentence = read(read_state_parts, message)->refused.refusal().sentence;
  EXPECT_NE(sentence.find("poses[10].name: "), std::string::npos);
  EXPECT_EQ(sentence.find("poses[11].name: "), std::string::npos);
  EXPECT_TRUE(sentence.ends_with("; and 19 more like these (the other 1 was accepted)")) << sentence;
}

TEST(StateParts, RejectAMessageWithoutGoodPosesOrWithABadHeader) {
  json none = state_of(2);
  none["poses"][0] = nullptr;
  none["poses"][1].erase("orientation");
  EXPECT_EQ(test::sentence_of(read(read_state_parts, none)),
            "poses[0]: expected an object, got null; poses[1].orientation: missing");
  json bad_header = state_of(2);
  bad_header["header"]["stamp"] = "now";
  EXPECT_EQ(test::sentence_of(read(read_state_parts, bad_header)),
            "header.stamp: expected a number, {secs, nsecs}, {sec, nanosec} or {sec, nsec}, got a string");
  EXPECT_EQ(test::sentence_of(read(read_state_parts, {{"poses", 1}})),
            "poses: expected an array, got a whole number");
  EXPECT_EQ(test::sentence_of(read(read_state_parts, json::object())), "poses: missing");
}

TEST(MarkerParts, HaveTheGoodMarkersAndASentenceForEachBadOne) {
  json message = test::good_markers();
  json bad = message["markers"][0];
  bad["color"]["a"] = 2;
  json turned = message["markers"][0];
  turned["header"]["frame_id"] = "map";
  message["markers"].insert(message["markers"].begin() + 1, bad);
  message["markers"].push_back(turned);
  const auto read_parts = read(read_markers_parts, message);
  ASSERT_TRUE(read_parts);
  ASSERT_EQ(read_parts->message.markers.size(), 2U);
  EXPECT_EQ(read_parts->message.markers[0].id, 7);
  EXPECT_EQ(read_parts->message.markers[1].id, 8);
  EXPECT_EQ(read_parts->refused.refusal().sentence,
            "markers[1].color.a: expected a number from 0 to 1, got 2; markers[3].header.frame_id: expected "
            "\"darpa\", got \"map\" (the setting rules.rewrite_frame_id accepts any frame) (the other 2 were "
            "accepted)");
  EXPECT_EQ(read_parts->refused.refusal().setting, "rules.rewrite_frame_id")
      << "the first error with a setting names it";
}

/// Writes each text as a byte string, keys too, as `cbor.dumps` of Python 2 does.
std::string as_python_2_writes_it(const json& message) {
  const auto rewrite = [](auto& self, const json& value) -> std::string {
    const auto bytes_of = [](const std::string& text) {
      const test::Bytes bytes = json::to_cbor(json::binary(test::Bytes(text.begin(), text.end())));
      return std::string(bytes.begin(), bytes.end());
    };
    if (value.is_string()) return bytes_of(value.get<std::string>());
    if (!value.is_structured()) return test::as_cbor(value);
    std::string made = test::as_cbor(value.is_array() ? json::array() : json::object());
    made[0] = static_cast<char>(made[0] | 0x1F);  // of indefinite length
    for (const auto& [key, child] : value.items()) {
      if (value.is_object()) made += bytes_of(key);
      made += self(self, child);
    }
    return made + '\xff';
  };
  return rewrite(rewrite, message);
}

Document read_python_2(const json& message, Split split) {
  auto document = decode({.format = Format::Cbor}, split, as_python_2_writes_it(message));
  EXPECT_TRUE(document.has_value());
  return document ? *std::move(document) : Document{};
}

Document read_python_3(const json& message, Split split) {
  return *decode({.format = Format::Cbor}, split, test::as_cbor(message));
}

TEST(TextOfPython2, IsTextInEachMappingMessage) {
  const json markers = test::good_markers(), state = test::good_state();
  EXPECT_EQ(read_state_update(read_python_2(state, Split::Nothing), {}),
            read_state_update(read_python_3(state, Split::Nothing), {}));
  EXPECT_EQ(read_markers_update(read_python_2(markers, Split::Nothing), {}),
            read_markers_update(read_python_3(markers, Split::Nothing), {}));
  for (json map : {test::good_grid(), test::good_cloud()}) {
    for (const char* name : {"husky_01", ""}) {
      map["name"] = name;
      const auto read = read_map_update(read_python_2(map, Split::MapData), {});
      ASSERT_TRUE(read) << read.error().sentence;
      test::expect_same(*read, *read_map_update(read_python_3(map, Split::MapData), {}));
    }
  }
}

TEST(TextOfPython2, IsRejectedUnlessUtf8) {
  json message = test::good_state();
  message["poses"][0]["name"] = json::binary({'r', 0xC3});
  const auto document = decode({.format = Format::Cbor}, Split::Nothing, test::as_cbor(message));
  ASSERT_TRUE(document);
  EXPECT_EQ(test::sentence_of(read_state_update(*document, {})),
            "poses[0].name: expected a string, got a byte string that is not UTF-8");
}

}  // namespace
}  // namespace adit::codec
