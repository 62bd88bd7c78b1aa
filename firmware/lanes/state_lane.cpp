#include "lanes/state_lane.hpp"

#include <algorithm>
#include <utility>

namespace adit::lanes {

std::size_t StateLane::unknown_in(const icd::StateUpdate& update) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      update.poses, [this](const icd::NamedPose& pose) { return !robots_.contains(pose.name); }));
}

bool StateLane::has_room_for(const icd::StateUpdate& update) const {
  const std::size_t unknown = unknown_in(update);
  if (unknown == 0 || robots_.size() + unknown <= kMostRobots) return true;
  const auto waiting = std::ranges::count_if(robots_, &Held::waits, &Robots::value_type::second);
  return static_cast<std::size_t>(waiting) + unknown <= kMostRobots;
}

void StateLane::add(const icd::StateUpdate& update, Instant now) {
  if (robots_.size() + unknown_in(update) > kMostRobots) {
    std::erase_if(robots_, [](const auto& robot) { return !robot.second.waits(); });
  }
  for (const icd::NamedPose& named : update.poses) {
    const Held newer{named.pose, update.header.stamp};
    const auto [held, is_new] = robots_.try_emplace(named.name, newer);
    held->second.is_news = true;
    if (is_new || !held->second.older_than(newer.stamp)) continue;
    held->second.pose = newer.pose;
    held->second.stamp = newer.stamp;
  }
  oldest_ = std::min(oldest_.value_or(now), now);
  ++updates_;
}

void StateLane::forget_what_was_taken() {
  std::erase_if(robots_, [](const auto& robot) { return !robot.second.waits(); });
}

void StateLane::add_unless_known(const icd::StateUpdate& update, Instant now) {
  for (const icd::NamedPose& named : update.poses) {
    Held& held = robots_.try_emplace(named.name, Held{named.pose, std::nullopt}).first->second;
    held.is_news = true;
    held.trial = {};
  }
  oldest_ = std::min(oldest_.value_or(now), now);
}

/// Of those that go apart and have news, the one that failed longest ago; first those that do not rest.
StateLane::Robots::iterator StateLane::next_apart(Instant now) {
  auto chosen = robots_.end();
  const auto rank = [&](const Held& held) {
    return std::pair(held.trial.rests(now), held.trial.failed.value_or(Instant{}));
  };
  for (auto each = robots_.begin(); each != robots_.end(); ++each) {
    if (!each->second.apart || !each->second.is_news) continue;
    if (chosen == robots_.end() || rank(each->second) < rank(chosen->second)) chosen = each;
  }
  return chosen;
}

void StateLane::include(WaitingState& taken, Robots::value_type& robot) {
  robot.second.is_under_way = std::exchange(robot.second.is_news, false);
  taken.update.poses.push_back({robot.first, robot.second.pose});
  taken.update.header.stamp = std::max(taken.update.header.stamp, robot.second.stamp);
}

std::optional<WaitingState> StateLane::take(Instant now) {
  if (!oldest_) return {};
  WaitingState taken{.update = {}, .accepted = *oldest_, .updates = std::max<std::uint64_t>(updates_, 1)};
  updates_ = 0;
  const auto together = [](const auto& robot) { return !robot.second.apart; };
  const bool others_have_news = std::ranges::any_of(
      robots_, [&](const auto& robot) { return together(robot) && robot.second.is_news; });
  const auto apart = next_apart(now);
  if (apart != robots_.end() && (!others_have_news || !apart->second.trial.rests(now))) {
    include(taken, *apart);
  } else {
    for (auto& robot : robots_) {
      if (together(robot)) include(taken, robot);
    }
  }
  for (auto& [name, held] : robots_) held.trial.steps_behind = false;
  if (std::ranges::none_of(robots_, [](const auto& robot) { return robot.second.is_news; })) oldest_.reset();
  return taken;
}

void StateLane::put_back(const WaitingState& state) {
  // The poses that were news are all here still.
  for (const icd::NamedPose& pose : state.update.poses) {
    const auto held = robots_.find(pose.name);
    if (held != robots_.end() && std::exchange(held->second.is_under_way, false)) held->second.is_news = true;
  }
  oldest_ = std::min(oldest_.value_or(state.accepted), state.accepted);
  updates_ += state.updates;
}

void StateLane::put_back_apart(const WaitingState& state) {
  put_back(state);
  for (const icd::NamedPose& pose : state.update.poses) {
    if (const auto held = robots_.find(pose.name); held != robots_.end()) held->second.apart = true;
  }
}

void StateLane::passed(const WaitingState& state) {
  for (const icd::NamedPose& pose : state.update.poses) {
    const auto held = robots_.find(pose.name);
    if (held == robots_.end()) continue;
    held->second.apart = held->second.is_under_way = false;
    held->second.trial = {};
  }
}

void StateLane::give_up(const icd::RobotName& name, Instant now) {
  Held& held = robots_[name];
  held.apart = true;
  held.is_under_way = false;
  held.trial = {};
  held.trial.rests_until = now + kRest;
}

icd::StateUpdate StateLane::unsent() const {
  icd::StateUpdate all;
  for (const auto& [name, held] : robots_) {
    if (!held.is_news) continue;
    all.poses.push_back({name, held.pose});
    all.header.stamp = std::max(all.header.stamp, held.stamp);
  }
  return all;
}

}  // namespace adit::lanes
