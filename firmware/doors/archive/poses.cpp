#include "archive/poses.hpp"

#include <algorithm>

#include "archive/record_kinds.hpp"

namespace adit::archive {

Poses::Poses(const std::vector<api::Track>& stored) {
  for (const api::Track& track : stored) last_ = std::max(last_, track.poses.back().at);
}

void Poses::add_to(Lines& lines, const std::vector<api::Track>& tracks, api::Time now) {
  for (const api::Track& track : tracks) {
    const bool is_news = has_moved(track);
    for (auto from = track.poses.begin(), end = track.poses.end(); from != end;) {
      const auto to = from + std::min<std::ptrdiff_t>(end - from, kLargestPoses);
      lines.add(record_of(api::Track{track.robot, {from, to}}), is_news);
      from = to;
    }
  }
  last_ = now;
}

/// The first pose of a robot counts as a move.
bool Poses::has_moved(const api::Track& track) {
  bool moves = false;
  for (const api::TrackPose& pose : track.poses) {
    const auto [last, is_new] = by_robot_.try_emplace(track.robot, pose);
    moves = moves || is_new || api::has_moved(last->second, pose);
    last->second = pose;
  }
  return moves;
}

}  // namespace adit::archive
