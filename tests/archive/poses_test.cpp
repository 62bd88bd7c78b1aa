#include <gtest/gtest.h>

#include "archive/write_queue.hpp"

namespace adit::archive {
namespace {

api::Track track(double at, double x) {
  api::TrackPose pose{};
  pose.at = at;
  pose.position.x = x;
  return {"X1", {pose}};
}

TEST(Poses, AreNewsOnlyIfTheRobotMoved) {
  const loop::Instant now = loop::Instant{} + std::chrono::hours(1);
  Lines lines;
  Poses poses({track(5, 0)});
  EXPECT_EQ(poses.last(), 5);
  poses.add_to(lines, {track(6, 0)}, 7);
  EXPECT_EQ(poses.last(), 7) << "later poses only";
  EXPECT_TRUE(lines.is_due(now)) << "the first pose of a robot";
  lines.pop(now);
  poses.add_to(lines, {track(8, 0)}, 8);
  EXPECT_FALSE(lines.is_due(now));
  poses.add_to(lines, {track(9, 100)}, 9);
  EXPECT_TRUE(lines.is_due(now));
}

}  // namespace
}  // namespace adit::archive
