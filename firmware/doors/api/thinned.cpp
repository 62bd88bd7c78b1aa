#include "api/thinned.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace adit::api {
namespace {

constexpr Time kLongest = 10;  // seconds, as between the poses of a robot that stands

TrackPose between(const TrackPose& from, const TrackPose& to, Time at) {
  const double part = (at - from.at) / (to.at - from.at);
  const auto mix = [part](double one, double other) { return one + part * (other - one); };
  return {.at = at,
          .position = {mix(from.position.x, to.position.x), mix(from.position.y, to.position.y),
                       mix(from.position.z, to.position.z)},
          .heading = from.heading + part * std::remainder(to.heading - from.heading, 2 * M_PI)};
}

bool is_straight(std::span<const TrackPose> way) {
  const TrackPose &from = way.front(), &to = way.back();
  if (to.at <= from.at || to.at > from.at + kLongest) return false;
  return std::ranges::none_of(way.subspan(1, way.size() - 2), [&](const TrackPose& pose) {
    return has_moved(between(from, to, pose.at), pose);
  });
}

std::vector<TrackPose> thinned(std::span<const TrackPose> poses) {
  std::vector<TrackPose> kept;
  for (std::size_t i = 0; i < poses.size();) {
    kept.push_back(poses[i]);
    std::size_t next = i + 1;
    while (next + 1 < poses.size() && is_straight(poses.subspan(i, next + 2 - i))) ++next;
    i = next;
  }
  return kept;
}

}  // namespace

Tracks thinned(std::vector<Track> tracks) {
  for (Track& track : tracks) track.poses = thinned(track.poses);
  return {std::move(tracks)};
}

}  // namespace adit::api
