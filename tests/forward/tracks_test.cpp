#include <gmock/gmock.h>

#include "forward/delivered_scene.hpp"

namespace adit::forward {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

api::TrackPose pose(double at, double x, double heading = 0) {
  return {.at = at, .position = {x, 0, 0}, .heading = heading};
}

std::vector<double> times(const Tracks& tracks, double since = 0) {
  std::vector<double> times;
  for (const auto& track : tracks.tracks_after(since)) {
    for (const auto& each : track.poses) times.push_back(each.at);
  }
  return times;
}

TEST(Tracks, KeepAPoseASecondOfAMovingRobot) {
  Tracks tracks;
  for (int i = 0; i <= 50; ++i) tracks.on_forwarded("r", pose(100 + i * 0.1, i));
  EXPECT_THAT(times(tracks), SizeIs(6));
  EXPECT_EQ(times(tracks).front(), 100);
}

TEST(Tracks, KeepAPoseEachTenSecondsOfAStandingRobot) {
  Tracks tracks;
  for (int i = 0; i <= 60; ++i) tracks.on_forwarded("r", pose(100 + i, 0));
  EXPECT_THAT(times(tracks), SizeIs(7));
}

TEST(Tracks, CountTurningOnTheSpotAsMoving) {
  Tracks tracks;
  for (int i = 0; i <= 10; ++i) tracks.on_forwarded("r", pose(100 + i, 0, i));
  EXPECT_THAT(times(tracks), SizeIs(11));
}

TEST(Tracks, ListPosesAfterATime) {
  Tracks tracks;
  for (int i = 0; i < 5; ++i) tracks.on_forwarded("r", pose(100 + i, i));
  tracks.on_forwarded("old", pose(90, 0));
  EXPECT_EQ(times(tracks, 102), (std::vector<double>{103, 104}));
  EXPECT_THAT(tracks.tracks_after(102), SizeIs(1)) << "no newer pose";
  EXPECT_THAT(tracks.tracks_after(200), IsEmpty());
  tracks.wipe();
  EXPECT_THAT(tracks.tracks_after(0), IsEmpty());
}

TEST(Tracks, AreLimitedAndKeepTheirBeginning) {
  Tracks tracks;
  for (int i = 0; i < 30000; ++i) tracks.on_forwarded("r", pose(100 + i, i));
  const auto kept = times(tracks);
  EXPECT_LE(kept.size(), Tracks::kMostPoses);
  EXPECT_GE(kept.size(), Tracks::kMostPoses / 2);
  EXPECT_EQ(kept.front(), 100);
  EXPECT_GT(kept.back(), 100 + 30000 - 20);
}

TEST(Tracks, ContinueAfterAClockStepBack) {
  Tracks tracks;
  for (int i = 0; i < 3; ++i) tracks.on_forwarded("r", pose(100 + i, i));
  tracks.move(-50);
  tracks.on_forwarded("r", pose(53, 9));
  EXPECT_THAT(times(tracks), testing::ElementsAre(50, 51, 52, 53));
}

}  // namespace
}  // namespace adit::forward
