#include "forward/tracks.hpp"

#include <algorithm>
#include <utility>

namespace adit::forward {
namespace {

constexpr double kEarly = 0.1;  // seconds: tolerance for poses once a second

std::vector<api::TrackPose> every_other(const std::vector<api::TrackPose>& poses) {
  std::vector<api::TrackPose> kept;
  kept.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); i += 2) kept.push_back(poses[i]);
  return kept;
}

}  // namespace

void Tracks::forwarded(const std::string& robot, const api::TrackPose& pose) {
  Kept& track = tracks_[robot];
  if (!track.poses.empty()) {
    const api::TrackPose& last = track.poses.back();
    const double least = has_moved(last, pose) ? track.spacing : std::max(kStill, track.spacing);
    if (pose.at < last.at + least - kEarly) return;
  }
  if (track.poses.size() == kMostPoses) {
    track.poses = every_other(track.poses);
    track.spacing *= 2;
  }
  track.poses.push_back(pose);
}

void Tracks::go_on_from(const std::vector<api::Track>& earlier) {
  const auto later = std::exchange(tracks_, {});
  for (const auto& [robot, poses] : earlier) {
    for (const api::TrackPose& pose : poses) forwarded(robot, pose);
  }
  for (const auto& [robot, kept] : later) {
    for (const api::TrackPose& pose : kept.poses) forwarded(robot, pose);
  }
}

void Tracks::move(double seconds) {
  for (auto& [robot, track] : tracks_) {
    for (api::TrackPose& pose : track.poses) pose.at += seconds;
  }
}

std::vector<api::Track> Tracks::since(api::Time since) const {
  std::vector<api::Track> tracks;
  for (const auto& [robot, kept] : tracks_) {
    const auto from = std::ranges::upper_bound(kept.poses, since, {}, &api::TrackPose::at);
    if (from != kept.poses.end()) tracks.push_back({robot, {from, kept.poses.end()}});
  }
  return tracks;
}

}  // namespace adit::forward
