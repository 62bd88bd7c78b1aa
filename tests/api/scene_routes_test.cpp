#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "api/map_scene.hpp"
#include "api/on_page.hpp"

namespace adit::api {
namespace {

using nlohmann::json;

class SceneRoutesTest : public OnPage {};

TEST_F(SceneRoutesTest, GiveChangedMarkers) {
  DrawnMarker marker = drawn_marker();
  marker.colors.push_back({0, 0, 0, 0.25});
  source.marker_changes = {.version = 1'793'000'123'456,
                           .whole = false,
                           .left_out = 2,
                           .markers = {{marker, 99.5}},
                           .gone = {{"path", 7}}};
  const auto answer = get("/adit/markers?since=1793000123400");
  EXPECT_EQ(source.since_version, 1'793'000'123'400u);
  EXPECT_EQ(header(answer, "Cache-Control"), "no-store");
  const json expected = {{"ns", "path"},
                         {"id", -3},
                         {"type", 4},
                         {"position", {{"x", 1.0}, {"y", 2.0}, {"z", 3.0}}},
                         {"heading", 1.57},
                         {"scale", {{"x", 4.0}, {"y", 5.0}, {"z", 6.0}}},
                         {"color", {{"r", 0.5}, {"g", 0.25}, {"b", 1.0}, {"a", 0.13}}},
                         {"points", {1.0, 2.0, -3.46, 4.0}},
                         {"colors", {"#ff0080ff", "#00000040"}},
                         {"point_count", 7000},
                         {"text", "here"},
                         {"mesh", "drill"},
                         {"lifetime", 2.5},
                         {"at", 99.5}};
  EXPECT_EQ(json::parse(answer.body), (json{{"version", 1'793'000'123'456},
                                            {"whole", false},
                                            {"left_out", 2},
                                            {"markers", {expected}},
                                            {"gone", {{{"ns", "path"}, {"id", 7}}}}}));
}

TEST_F(SceneRoutesTest, GiveTracksOfRobots) {
  source.robot_tracks = {{"r1", {{.at = 100.126, .position = {1.234, 5, -6}, .heading = 3.14159}}}};
  const auto answer = get("/adit/tracks?since=90.5");
  EXPECT_EQ(source.since_time, 90.5);
  EXPECT_EQ(json::parse(answer.body),
            (json{{"tracks", {{{"robot", "r1"}, {"poses", {{100.13, 1.23, 5.0, -6.0, 3.14}}}}}}}));
}

/// One pose per second, given by `to(second)`.
template <typename To>
std::vector<TrackPose> each_second(int count, To to) {
  std::vector<TrackPose> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back(to(i));
    poses.back().at = 100 + i;
  }
  return poses;
}

TEST_F(SceneRoutesTest, OmitPosesThatInterpolationGives) {
  const auto times_of = [this](std::vector<TrackPose> poses) {
    source.robot_tracks = {{"r1", std::move(poses)}};
    std::vector<int> seconds;
    for (const json& pose : json::parse(get("/adit/tracks").body)["tracks"][0]["poses"])
      seconds.push_back(pose[0].get<int>() - 100);
    return seconds;
  };
  using testing::ElementsAre;
  const auto ahead = [](double i) { return TrackPose{.position = {2 * i, i, 0}, .heading = 0.1 * i}; };
  EXPECT_THAT(times_of(each_second(1, ahead)), ElementsAre(0));
  EXPECT_THAT(times_of(each_second(25, ahead)), ElementsAre(0, 10, 20, 24))
      << "on a straight line at most 10 s apart";
  EXPECT_THAT(
      times_of(each_second(7, [](double i) { return TrackPose{.position = {std::abs(i - 3), 0, 0}}; })),
      ElementsAre(0, 3, 6))
      << "a turn back";
  EXPECT_THAT(
      times_of(each_second(7, [](double i) { return TrackPose{.position = {i, 0, i > 3 ? 5.0 : 0}}; })),
      ElementsAre(0, 3, 4, 6))
      << "a step up";
  EXPECT_THAT(
      times_of(each_second(7, [](double i) { return TrackPose{.position = {i > 3 ? 2 * i : i, 0, 0}}; })),
      ElementsAre(0, 3, 4, 6))
      << "a change of speed";
  EXPECT_THAT(
      times_of(each_second(7, [](double i) { return TrackPose{.position = {}, .heading = 2 + 0.3 * i}; })),
      ElementsAre(0, 6))
      << "a turn past pi";
  auto stepped = each_second(3, ahead);
  stepped[2].at = 90;  // the clock was set back
  EXPECT_THAT(times_of(stepped), ElementsAre(0, 1, -10));
}

TEST_F(SceneRoutesTest, CompressTheLongestTracksOfTwentyRobots) {
  const auto poses = each_second(
      4000, [](int i) { return TrackPose{.position = {i % 97 / 7.0, i % 89 / 3.0, i % 7 / 9.0}}; });
  for (int i = 0; i < 20; ++i) source.robot_tracks.push_back({"r" + std::to_string(i), poses});
  const auto answer = request("GET", "/adit/tracks", {{"Accept-Encoding", "gzip"}, kByToken});
  EXPECT_EQ(header(answer, "Content-Encoding"), "gzip");
}

TEST_F(SceneRoutesTest, NameAnInvalidNumber) {
  for (const char* wrong : {"/adit/markers?since=x", "/adit/markers?since=-1", "/adit/markers?since=1.5",
                            "/adit/tracks?since=x", "/adit/tracks?since=inf", "/adit/tracks?since=nan"}) {
    const auto answer = get(wrong);
    EXPECT_EQ(answer.status, icd::Status::BadRequest) << wrong;
    EXPECT_TRUE(answer.body.starts_with("\"since: expected")) << wrong;
  }
}

}  // namespace
}  // namespace adit::api
