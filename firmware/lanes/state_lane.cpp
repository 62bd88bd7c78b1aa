#include "lanes/state_lane.hpp"

#include <algorithm>
#include <utility>

namespace adit::lanes {

bool StateLane::has_room_for(const icd::StateUpdate& update) const {
  const auto unknown = std::ranges::count_if(
      update.poses, [this](const icd::NamedPose& pose) { return !robots_.contains(pose.name); });
  return unknown == 0 || robots_.size() + static_cast<std::size_t>(unknown) <= kMostRobots;
}

void StateLane::add(const icd::StateUpdate& update, Instant now) {
  for (const icd::NamedPose& named : update.poses) {
    const Held newer{named.pose, update.header.stamp};
    const auto [held, is_new] = robots_.try_emplace(named.name, newer);
    if (!is_new && held->second.older_than(newer.stamp)) held->second = newer;
  }
  oldest_ = std::min(oldest_.value_or(now), now);
  ++updates_;
}

std::optional<WaitingState> StateLane::take() {
  const auto accepted = std::exchange(oldest_, std::nullopt);
  if (!accepted) return {};
  WaitingState taken;
  taken.accepted = *accepted;
  taken.updates = std::exchange(updates_, 0);
  for (const auto& [name, held] : robots_) {
    taken.update.poses.push_back({name, held.pose});
    taken.update.header.stamp = std::max(taken.update.header.stamp, held.stamp);
  }
  return taken;
}

void StateLane::put_back(const WaitingState& state) {
  // The robots and their poses are all here still: what was taken is only no longer news.
  oldest_ = std::min(oldest_.value_or(state.accepted), state.accepted);
  updates_ += state.updates;
}

}  // namespace adit::lanes
