// One row for each rule of the ICD about POST /state/update and POST /markers/update, as JSON and as CBOR.
#include <gtest/gtest.h>

#include <cmath>

#include "codec/icd_row.hpp"
#include "codec/messages.hpp"
#include "codec/read.hpp"
#include "codec/read_map.hpp"

namespace adit::codec {
namespace {

using test::IcdRow;
using test::json;
using test::kNan;

template <class Message>
using Reader = icd::Checked<Message> (*)(const Document&, const icd::Rules&);

template <class Message>
icd::Checked<Message> read(Reader<Message> reader, Format format, const std::string& body,
                           const icd::Rules& rules = {}) {
  const auto document = decode({.format = format}, Split::Nothing, body);
  if (!document) return std::unexpected(document.error());
  return reader(*document, rules);
}

template <class Message>
void expect_answers(Reader<Message> reader, std::span<const IcdRow> rows, const json& good,
                    const icd::Rules& rules = {}) {
  for (const IcdRow& row : rows) {
    json message = good;
    row.change(message);
    EXPECT_EQ(test::sentence_of(read(reader, Format::Cbor, test::as_cbor(message), rules)), row.sentence)
        << "ICD " << row.section << ", CBOR";
    if (row.sentence.ends_with("nan")) continue;  // JSON has no NaN
    EXPECT_EQ(test::sentence_of(read(reader, Format::Json, test::as_json(message), rules)), row.sentence)
        << "ICD " << row.section << ", JSON";
  }
}

TEST(ReadStateUpdate, RejectsAForbiddenState) {
  const IcdRow rows[] = {
      {"6.5", [](json&) {}, "accepted"},
      {"6.5", [](json& m) { m["poses"] = json::array(); }, "accepted"},
      {"6.5", [](json& m) { m.erase("header"); }, "accepted"},
      {"6.5", [](json& m) { m["header"] = nullptr; }, "accepted"},
      {"6.5", [](json& m) { m["extra"] = {1, 2}; }, "accepted"},
      {"6.5", [](json& m) { m = nullptr; }, "the body: expected an object, got null"},
      {"6.5", [](json& m) { m["header"] = json::array(); }, "header: expected an object, got an array"},
      {"6.1", [](json& m) { m["header"]["frame_id"] = "odom"; },
       "header.frame_id: expected \"darpa\", got \"odom\" (the setting rules.rewrite_frame_id accepts any "
       "frame)"},
      {"6.2", [](json& m) { m["header"]["stamp"] = -1; },
       "header.stamp: expected a number from 0 to 4294967295.9999995, got -1"},
      {"6.2", [](json& m) { m["header"]["stamp"] = kNan; },
       "header.stamp: expected a number from 0 to 4294967295.9999995, got nan"},
      {"6.5", [](json& m) { m.erase("poses"); }, "poses: missing"},
      {"6.5", [](json& m) { m["poses"] = nullptr; }, "poses: expected an array, got null"},
      {"6.5", [](json& m) { m["poses"] = json::object(); }, "poses: expected an array, got an object"},
      {"6.5", [](json& m) { m["poses"][1] = 1; }, "poses[1]: expected an object, got a whole number"},
      {"6.5", [](json& m) { m["poses"][1].erase("name"); }, "poses[1].name: missing"},
      {"6.5", [](json& m) { m["poses"][1]["name"] = nullptr; }, "poses[1].name: expected a string, got null"},
      {"2, 6.5", [](json& m) { m["poses"][1]["name"] = ""; },
       "poses[1].name: expected 1 to 10 letters, digits and underscores, got \"\""},
      {"2, 6.5", [](json& m) { m["poses"][1]["name"] = "drone 2"; },
       "poses[1].name: expected 1 to 10 letters, digits and underscores, got \"drone 2\" (the setting "
       "robots[].alias can map this name to a valid one)"},
      {"6.5", [](json& m) { m["poses"][0].erase("position"); }, "poses[0].position: missing"},
      {"6.5 and ROS",
       [](json& m) {
         json& pose = m["poses"][0];
         pose = {{"name", pose["name"]},
                 {"pose", {{"position", pose["position"]}, {"orientation", pose["orientation"]}}}};
       },
       "poses[0].position, poses[0].orientation: missing (found pose: put the pose's position and "
       "orientation here)"},
      {"6.5 and ROS", [](json& m) { m = {{"pose", m["poses"][0]}}; },
       "poses: missing (found pose: expected a list of robots, each with name, position and orientation)"},
      {"6.5", [](json& m) { m["poses"][0]["position"]["y"] = "1"; },
       "poses[0].position.y: expected a number, got a string"},
      {"6.5", [](json& m) { m["poses"][0]["position"]["y"] = kNan; },
       "poses[0].position.y: expected a finite number, got nan"},
      {"6.5", [](json& m) { m["poses"][0].erase("orientation"); }, "poses[0].orientation: missing"},
      {"6.5", [](json& m) { m["poses"][0]["orientation"].erase("w"); }, "poses[0].orientation.w: missing"},
      {"6.5", [](json& m) { m["poses"][0]["orientation"]["w"] = true; },
       "poses[0].orientation.w: expected a number, got true or false"},
      {"6.5", [](json& m) { m["poses"][1]["orientation"] = test::quaternion(0, 1e-300, 0, 0); },
       "poses[1].orientation: expected a quaternion of length 1, got one too short to have a direction"},
  };
  expect_answers(read_state_update, rows, test::good_state());
}

TEST(ReadUpdates, NormalizeEachQuaternion) {
  const json twice = test::quaternion(0, 0, 1.2, 1.6);
  const icd::Quaternion once{0, 0, 0.6, 0.8};
  const auto expect_once = [&](const icd::Pose& pose) {
    EXPECT_NEAR(pose.orientation.z, once.z, 1e-15);
    EXPECT_NEAR(pose.orientation.w, once.w, 1e-15);
  };
  json state = test::good_state(), markers = test::good_markers(), grid = test::good_grid(),
       cloud = test::good_cloud();
  state["poses"][1]["orientation"] = twice;
  markers["markers"][0]["pose"]["orientation"] = twice;
  grid["msg"]["info"]["origin"]["orientation"] = twice;
  cloud["msg"]["origin"]["orientation"] = twice;
  for (const Format format : {Format::Json, Format::Cbor}) {
    const auto bytes = [&](const json& message) {
      return format == Format::Json ? test::as_json(message) : test::as_cbor(message);
    };
    expect_once(read(read_state_update, format, bytes(state)).value().poses.at(1).pose);
    expect_once(read(read_markers_update, format, bytes(markers)).value().markers.at(0).pose);
    expect_once(std::get<icd::OccupancyGrid>(test::read_map(format, bytes(grid)).value().msg).origin);
    expect_once(std::get<icd::PointCloud2>(test::read_map(format, bytes(cloud)).value().msg).origin.value());
  }
}

TEST(ReadStateUpdate, KeepsItsMembers) {
  const auto state = read(read_state_update, Format::Json, test::as_json(test::good_state()));
  ASSERT_TRUE(state.has_value());
  EXPECT_EQ(state->header.stamp, 721.4);
  ASSERT_EQ(state->poses.size(), 2U);
  EXPECT_EQ(state->poses[1].name.text(), "drone_02");
  EXPECT_EQ(state->poses[1].pose, (icd::Pose{{2, -2.5, 0.25}, {0, 0, 0.6, 0.8}}));
}

TEST(ReadStateUpdate, KeepsTheLastPoseOfARobotNamedTwice) {
  json message = test::good_state();
  message["poses"].push_back(message["poses"][0]);
  message["poses"][2]["position"]["x"] = 9;
  const auto state = read(read_state_update, Format::Json, test::as_json(message));
  ASSERT_TRUE(state.has_value());
  ASSERT_EQ(state->poses.size(), 2U);
  EXPECT_EQ(state->poses[0].name.text(), "husky_01");
  EXPECT_EQ(state->poses[0].pose.position.x, 9);
}

TEST(ReadStateUpdate, MakesAnAllZeroQuaternionTheIdentity) {
  json message = test::good_state();
  message["poses"][0]["orientation"] = {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 0}};
  const auto state = read(read_state_update, Format::Cbor, test::as_cbor(message));
  ASSERT_TRUE(state.has_value());
  EXPECT_EQ(state->poses[0].pose.orientation, icd::Quaternion{});
}

TEST(ReadStateUpdate, NamesAMemberUnderAForeignCborTag) {
  constexpr std::uint64_t kRational = 30;
  const json tagged = json::binary({1, 2}, kRational);  // nlohmann writes it with that tag
  const IcdRow rows[] = {
      {"6.5", [&](json& m) { m["poses"][0]["covariance"] = {tagged, {{"x", tagged}}}; }, "accepted"},
      {"6.5", [&](json& m) { m["poses"][0]["position"]["x"] = tagged; },
       "poses[0].position.x: expected a number, got CBOR tag 30, which changes the meaning of its value"},
      {"6.5", [&](json& m) { m["poses"][0]["name"] = tagged; },
       "poses[0].name: expected a string, got CBOR tag 30, which changes the meaning of its value"},
      {"6.5", [&](json& m) { m["header"] = tagged; },
       "header: expected an object, got CBOR tag 30, which changes the meaning of its value"},
      {"6.5", [&](json& m) { m = tagged; },
       "the body: expected an object, got CBOR tag 30, which changes the meaning of its value"},
  };
  for (const IcdRow& row : rows) {
    json message = test::good_state();
    row.change(message);
    EXPECT_EQ(test::sentence_of(read(read_state_update, Format::Cbor, test::as_cbor(message))), row.sentence);
  }
}

TEST(ReadStateUpdate, AddsSecondsAndNanoseconds) {  // stamps of ROS 1, ROS 2 and their C++ types
  for (const auto& [seconds, nanoseconds] :
       {std::pair("secs", "nsecs"), std::pair("sec", "nanosec"), std::pair("sec", "nsec")}) {
    json message = test::good_state();
    message["header"]["stamp"] = {{seconds, 1617235200}, {nanoseconds, 250'000'000.0}};
    const auto state = read(read_state_update, Format::Json, test::as_json(message));
    ASSERT_TRUE(state.has_value()) << nanoseconds;
    EXPECT_EQ(state->header.stamp, 1617235200.25) << nanoseconds;
  }
}

/// The double nearest to ROS's last time stamp is a second that ROS does not have.
TEST(ReadMarkersUpdate, StaysWithinRosTimesByRounding) {
  json message = test::good_markers();
  message["markers"][0]["header"]["stamp"] = {{"secs", 4294967295}, {"nsecs", 999'999'999}};
  message["markers"][0]["lifetime"] = {{"secs", 2147483647}, {"nsecs", 999'999'999}};
  const auto update = read(read_markers_update, Format::Cbor, test::as_cbor(message));
  ASSERT_TRUE(update.has_value());
  EXPECT_EQ(std::trunc(update->markers[0].header.stamp.value()), 4294967295);
  EXPECT_EQ(std::trunc(update->markers[0].lifetime), 2147483647);
}

TEST(ReadMarkersUpdate, GivesAMarkerWithoutNamespaceOne) {
  json message = test::good_markers();
  const json marker = message["markers"][0];
  for (int i = 1; i < 4; ++i) message["markers"].push_back(marker);
  message["markers"][0]["ns"] = "";
  message["markers"][1].erase("ns");
  message["markers"][1]["action"] = 2;
  message["markers"][2]["ns"] = "";
  message["markers"][2]["action"] = 3;
  const auto update = read(read_markers_update, Format::Json, test::as_json(message));
  ASSERT_TRUE(update.has_value());
  EXPECT_EQ(update->markers[0].ns, icd::kUnnamedMarkers);
  EXPECT_EQ(update->markers[1].ns, icd::kUnnamedMarkers) << "a delete must find the marker";
  EXPECT_EQ(update->markers[2].ns, "") << "delete-all has no namespace";
  EXPECT_EQ(update->markers[3].ns, marker["ns"].get<std::string>());
}

TEST(ReadStateUpdate, RejectsAMemberGivenTwice) {
  const std::string position = R"({"x":1,"y":2,"z":3})";
  const std::string orientation = R"({"x":0,"y":0,"z":0,"w":1})";
  const auto answer = [&](const std::string& members) {
    const std::string body = R"({"poses":[{"name":"a","position":)" + position + R"(,"orientation":)" +
                             orientation + members + "}]}";
    return test::sentence_of(read(read_state_update, Format::Json, body));
  };
  EXPECT_EQ(answer(""), "accepted");
  EXPECT_EQ(answer(R"(,"name":"a")"), "poses[0].name: given twice");
  EXPECT_EQ(answer(R"(,"position":)" + position), "poses[0].position: given twice");
  EXPECT_EQ(answer(R"(,"covariance":1,"covariance":1)"), "accepted");
  EXPECT_EQ(test::sentence_of(read(read_state_update, Format::Json, R"({"poses":[],"poses":[]})")),
            "poses: given twice");
}

TEST(ReadMarkersUpdate, RejectsForbiddenMarkers) {
  const IcdRow rows[] = {
      {"6.6", [](json&) {}, "accepted"},
      {"6.6", [](json& m) { m["markers"] = json::array(); }, "accepted"},
      {"6.6", [](json& m) { m.erase("markers"); }, "markers: missing"},
      {"6.6", [](json& m) { m["markers"] = 1; }, "markers: expected an array, got a whole number"},
      {"6.6", [](json& m) { m["markers"][0] = nullptr; }, "markers[0]: expected an object, got null"},
      {"6.1", [](json& m) { m["markers"][0]["header"]["frame_id"] = "map"; },
       "markers[0].header.frame_id: expected \"darpa\", got \"map\" (the setting rules.rewrite_frame_id "
       "accepts any frame)"},
      {"6.2", [](json& m) { m["markers"][0]["header"]["stamp"] = -2; },
       "markers[0].header.stamp: expected a number from 0 to 4294967295.9999995, got -2"},
      {"6.6", [](json& m) { m["markers"][0].erase("ns"); }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["ns"] = nullptr; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["ns"] = 5; },
       "markers[0].ns: expected a string, got a whole number"},
      {"6.6", [](json& m) { m["markers"][0].erase("id"); }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["id"] = 7.0; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["id"] = -2147483648; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["id"] = 2147483648; },
       "markers[0].id: expected a whole number from -2147483648 to 2147483647, got 2147483648"},
      {"6.6", [](json& m) { m["markers"][0]["id"] = "7"; },
       "markers[0].id: expected a whole number, got a string"},
      {"6.6", [](json& m) { m["markers"][0].erase("type"); }, "markers[0].type: missing"},
      {"6.6", [](json& m) { m["markers"][0]["type"] = 11; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["type"] = 12; },
       "markers[0].type: expected a whole number from 0 to 11, got 12"},
      {"6.6", [](json& m) { m["markers"][0]["type"] = -1; },
       "markers[0].type: expected a whole number from 0 to 11, got -1"},
      {"6.6", [](json& m) { m["markers"][0].erase("action"); }, "markers[0].action: missing"},
      {"6.6", [](json& m) { m["markers"][0]["action"] = 1; },
       "markers[0].action: expected 0 (add), 2 (delete) or 3 (delete all), got 1"},
      {"6.6", [](json& m) { m["markers"][0]["action"] = 256; },
       "markers[0].action: expected 0 (add), 2 (delete) or 3 (delete all), got 256"},
      {"6.6", [](json& m) { m["markers"][0]["action"] = "add"; },
       "markers[0].action: expected a whole number, got a string"},
      {"6.6", [](json& m) { m["markers"][0].erase("pose"); }, "markers[0].pose: missing"},
      {"6.6", [](json& m) { m["markers"][0]["pose"].erase("orientation"); },
       "markers[0].pose.orientation: missing"},
      {"6.6", [](json& m) { m["markers"][0]["pose"]["orientation"] = test::quaternion(0, 0, 1e-7, 0); },
       "markers[0].pose.orientation: expected a quaternion of length 1, got one too short to have a "
       "direction"},
      {"6.6", [](json& m) { m["markers"][0].erase("scale"); }, "markers[0].scale: missing"},
      {"6.6", [](json& m) { m["markers"][0]["scale"]["z"] = kNan; },
       "markers[0].scale.z: expected a finite number, got nan"},
      {"6.6", [](json& m) { m["markers"][0].erase("color"); }, "markers[0].color: missing"},
      {"6.6", [](json& m) { m["markers"][0]["color"].erase("a"); }, "markers[0].color.a: missing"},
      {"6.6", [](json& m) { m["markers"][0]["color"]["a"] = 2; },
       "markers[0].color.a: expected a number from 0 to 1, got 2"},
      {"6.6 and ROS's float32", [](json& m) { m["markers"][0]["color"]["a"] = 1.0000001192; }, "accepted"},
      {"6.6 and ROS's float32", [](json& m) { m["markers"][0]["color"]["a"] = -1.1e-7; }, "accepted"},
      {"6.6 and ROS's float32", [](json& m) { m["markers"][0]["color"]["a"] = 1.0000003; },
       "markers[0].color.a: expected a number from 0 to 1, got 1.0000003"},
      {"6.6 and ROS's float32", [](json& m) { m["markers"][0]["color"]["a"] = -2e-7; },
       "markers[0].color.a: expected a number from 0 to 1, got -2e-07"},
      {"6.6", [](json& m) { m["markers"][0]["color"]["r"] = -0.5; },
       "markers[0].color.r: expected a number from 0 to 1, got -0.5"},
      {"6.6", [](json& m) { m["markers"][0]["color"]["g"] = kNan; },
       "markers[0].color.g: expected a number from 0 to 1, got nan"},
      {"6.6", [](json& m) { m["markers"][0]["color"]["b"] = "1"; },
       "markers[0].color.b: expected a number from 0 to 1, got a string"},
      {"6.6", [](json& m) { m["markers"][0].erase("lifetime"); }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["lifetime"] = nullptr; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["lifetime"] = {{"secs", 5}, {"nsecs", 0}}; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["lifetime"] = {{"sec", 5}, {"nanosec", 0}}; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["lifetime"] = {{"sec", 5}, {"nsec", 0}}; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["lifetime"] = -1; },
       "markers[0].lifetime: expected a number from 0 to 2147483647.9999998, got -1"},
      {"6.6 and ROS's duration", [](json& m) { m["markers"][0]["lifetime"] = 2147483647.5; }, "accepted"},
      {"6.6 and ROS's duration", [](json& m) { m["markers"][0]["lifetime"] = 1e-300; }, "accepted"},
      {"6.6 and ROS's duration", [](json& m) { m["markers"][0]["lifetime"] = 3e9; },
       "markers[0].lifetime: expected a number from 0 to 2147483647.9999998, got 3e+09"},
      {"6.6 and ROS's duration", [](json& m) { m["markers"][0]["lifetime"] = 1e300; },
       "markers[0].lifetime: expected a number from 0 to 2147483647.9999998, got 1e+300"},
      {"6.6 and ROS's duration",
       [](json& m) { m["markers"][0]["lifetime"] = {{"secs", 3'000'000'000}, {"nsecs", 0}}; },
       "markers[0].lifetime.secs: expected a whole number from 0 to 2147483647, got 3000000000"},
      {"6.6", [](json& m) { m["markers"][0]["lifetime"] = {{"secs", 5}, {"nsecs", -1}}; },
       "markers[0].lifetime.nsecs: expected a whole number from 0 to 999999999, got -1"},
      {"6.6", [](json& m) { m["markers"][0].erase("text"); }, "accepted"},
      {"6.6", [](json& m) { m["markers"][0]["text"] = 1; },
       "markers[0].text: expected a string, got a whole number"},
      {"6.6", [](json& m) { m["markers"][1] = {{"action", 3}}; }, "accepted"},
      {"6.6", [](json& m) { m["markers"][1]["pose"] = 1; },
       "markers[1].pose: expected an object, got a whole number"},
      {"6.6", [](json& m) { m["markers"][1].erase("action"); }, "markers[1].action: missing"},
  };
  expect_answers(read_markers_update, rows, test::good_markers());
}

TEST(ReadMarkersUpdate, KeepsItsMembers) {
  const auto update = read(read_markers_update, Format::Cbor, test::as_cbor(test::good_markers()));
  ASSERT_TRUE(update.has_value());
  ASSERT_EQ(update->markers.size(), 2U);
  EXPECT_EQ(update->markers[0], (icd::Marker{.header = {721.4},
                                             .ns = "artifacts",
                                             .id = 7,
                                             .type = 2,
                                             .action = icd::MarkerAction::Add,
                                             .pose = {{3, -2.5, 0.25}, {0, 0, 0.6, 0.8}},
                                             .scale = {1, 1, 1},
                                             .color = {1, 0.5, 0, 1},
                                             .lifetime = 10.5,
                                             .text = "Backpack"}));
  icd::Marker deleted;
  deleted.ns = "artifacts";
  deleted.id = 8;
  deleted.action = icd::MarkerAction::Delete;
  EXPECT_EQ(update->markers[1], deleted);
}

TEST(ReadMarkersUpdate, ClampsColorsThatRoundingPutPastTheLimit) {
  json message = test::good_markers();
  message["markers"][0]["color"] = {{"r", 1.0000001192}, {"g", -1e-9}, {"b", 0.99999994}, {"a", 1.00000001}};
  const auto update = read(read_markers_update, Format::Json, test::as_json(message));
  ASSERT_TRUE(update.has_value());
  EXPECT_EQ(update->markers[0].color, (icd::Color{1, 0, 0.99999994, 1}));
}

TEST(ReadMarkersUpdate, RewritesTheFrameIfTheSettingsSaySo) {
  icd::Rules rules;
  rules.rewrite_frame_id = true;
  const IcdRow rows[] = {{"6.1", [](json& m) { m["markers"][0]["header"]["frame_id"] = "map"; }, "accepted"}};
  expect_answers(read_markers_update, rows, test::good_markers(), rules);
}

TEST(StateUpdates, ReplaceAliasesByNames) {
  icd::Rules rules;
  rules.aliases.emplace("husky-number-1", *icd::RobotName::parse("ugv1"));
  const auto name_of = [&](const std::string& name) {
    const std::string pose = R"("position":{"x":1,"y":0,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1})";
    const auto update =
        read(&read_state_update, Format::Json, R"({"poses":[{"name":")" + name + "\"," + pose + "}]}", rules);
    return update ? update->poses.at(0).name.text() : "refused";
  };
  EXPECT_EQ(name_of("husky-number-1"), "ugv1");
  EXPECT_EQ(name_of("ugv1"), "ugv1");
  EXPECT_EQ(name_of("husky-number-2"), "refused");
}

}  // namespace
}  // namespace adit::codec
