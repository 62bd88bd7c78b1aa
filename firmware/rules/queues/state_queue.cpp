#include "queues/state_queue.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace adit::queues {

std::size_t StateQueue::unknown_in(const auto& poses) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(poses, [this](const auto& pose) { return !robots_.contains(pose.name); }));
}

bool StateQueue::has_room_for(const icd::StateUpdate& update) const {
  const std::size_t unknown = unknown_in(update.poses);
  if (unknown == 0 || robots_.size() + unknown <= kMostRobots) return true;
  const auto waiting = std::ranges::count_if(robots_, &HeldPose::is_pending, &Robots::value_type::second);
  return static_cast<std::size_t>(waiting) + unknown <= kMostRobots;
}

std::vector<PostedPose> StateQueue::news_in(std::span<const PostedPose> poses) const {
  std::vector<PostedPose> news;
  for (const PostedPose& pose : poses) {
    const auto held = robots_.find(pose.name);
    if (held == robots_.end() || !pose.is_older_than(held->second.posted)) news.push_back(pose);
  }
  return news;
}

void StateQueue::add(std::span<const PostedPose> news, Instant now) {
  if (news.empty()) return;
  if (robots_.size() + unknown_in(news) > kMostRobots) forget_accepted();
  for (const PostedPose& newer : news) {
    const auto [robot, is_new] = robots_.try_emplace(newer.name, HeldPose{newer});
    HeldPose& held = robot->second;
    held.posted = newer;
    if (is_new || !held.is_news) held.accepted = now;
    held.is_news = held.is_of_run = true;
    held.is_given_up = false;
  }
}

void StateQueue::forget_accepted() {
  std::erase_if(robots_, [](const auto& robot) { return !robot.second.is_pending(); });
}

void StateQueue::add_unless_known(const icd::StateUpdate& update, Instant now) {
  for (const icd::NamedPose& named : update.poses) {
    const auto [robot, is_new] = robots_.try_emplace(named.name, HeldPose{{named.name, named.pose}});
    HeldPose& held = robot->second;
    if (!is_new && !std::exchange(held.is_given_up, false)) continue;
    if (is_new || !held.is_news) held.accepted = now;
    held.is_news = true;
    held.trial = {};
  }
}

std::optional<StateQueue::NextState> StateQueue::next(Instant now) const {
  std::optional<NextState> next;
  const auto rank = [now](const NextState& one) { return std::pair(std::max(one.ready, now), one.accepted); };
  for (const auto& [name, held] : robots_) {
    if (!held.is_news) continue;
    const NextState its{held.ready(), held.accepted};
    if (!next || rank(its) < rank(*next)) next = its;
  }
  return next;
}

/// The robot that goes apart, does not rest, and failed longest ago. Robots with news come first, then robots
/// that repeat their pose, and last the robot that failed just now.
StateQueue::Robots::iterator StateQueue::next_single(Instant now) {
  auto chosen = robots_.end();
  const auto rank = [&](const HeldPose& held) {
    return std::tuple(held.trial.steps_behind, !held.is_news, held.trial.failed.value_or(Instant{}));
  };
  for (auto each = robots_.begin(); each != robots_.end(); ++each) {
    if (!each->second.apart || !each->second.can_send() || each->second.ready() > now) continue;
    if (chosen == robots_.end() || rank(each->second) < rank(chosen->second)) chosen = each;
  }
  return chosen;
}

void StateQueue::include(QueuedState& taken, Robots::value_type& robot) {
  HeldPose& held = robot.second;
  const PostedPose& posted = held.posted;
  held.in_flight = held.is_news ? std::optional(held.accepted) : std::nullopt;
  if (held.is_news) taken.news.push_back(posted.to_named_pose());
  held.is_news = false;
  taken.update.poses.push_back(posted.to_named_pose());
  taken.update.header.stamp = std::max(taken.update.header.stamp, posted.stamp);
}

std::optional<QueuedState> StateQueue::pop(Instant now) {
  const auto first = next(now);
  if (!first || first->ready > now) return {};
  QueuedState taken{.update = {}, .news = {}, .accepted = first->accepted};
  const auto together = [](const auto& robot) { return !robot.second.apart; };
  const bool others_have_news = std::ranges::any_of(
      robots_, [&](const auto& robot) { return together(robot) && robot.second.is_news; });
  const bool has_failed = std::ranges::any_of(
      robots_, [&](const auto& robot) { return !together(robot) && robot.second.trial.steps_behind; });
  const auto apart = next_single(now);
  if (apart != robots_.end() && !(has_failed && others_have_news)) {
    include(taken, *apart);
  } else {
    for (auto& robot : robots_) {
      if (together(robot) && robot.second.can_send()) include(taken, robot);
    }
  }
  for (auto& [name, held] : robots_) held.trial.steps_behind = false;
  return taken;
}

void StateQueue::put_back(const QueuedState& state) {
  // All poses that were news are still held.
  for (const icd::NamedPose& pose : state.update.poses) {
    const auto held = robots_.find(pose.name);
    if (held == robots_.end() || !held->second.in_flight) continue;
    held->second.accepted = *std::exchange(held->second.in_flight, std::nullopt);
    held->second.is_news = true;
  }
}

void StateQueue::put_back_single(const QueuedState& state) {
  put_back(state);
  for (const icd::NamedPose& pose : state.update.poses) {
    if (const auto held = robots_.find(pose.name); held != robots_.end()) held->second.apart = true;
  }
}

void StateQueue::on_passed(const QueuedState& state) {
  bool was_outage = false;
  for (const icd::NamedPose& pose : state.update.poses) {
    const auto held = robots_.find(pose.name);
    if (held == robots_.end()) continue;
    HeldPose& its = held->second;
    was_outage = was_outage || (its.trial.failures > 0 && its.trial.strikes == 0);
    its.is_given_up = false;
    its.in_flight.reset();
    its.join();
  }
  if (!was_outage) return;
  for (auto& [name, held] : robots_) {
    if (held.trial.strikes == 0) held.join();
  }
}

void StateQueue::give_up(const icd::RobotName& name, Instant now) {
  const auto robot = robots_.find(name);
  if (robot == robots_.end()) return;
  HeldPose& held = robot->second;
  held.apart = held.is_given_up = true;
  held.in_flight.reset();
  held.trial = {};
  held.trial.rests_until = now + kRest;
}

Trial* StateQueue::trial_of(const QueuedState& state) {
  if (state.update.poses.size() != 1) return nullptr;
  const auto robot = robots_.find(state.update.poses.front().name);
  return robot == robots_.end() ? nullptr : &robot->second.trial;
}

std::optional<Instant> StateQueue::accepted_at(const icd::RobotName& name) const {
  const auto robot = robots_.find(name);
  if (robot == robots_.end() || !robot->second.is_pending()) return std::nullopt;
  return robot->second.in_flight.value_or(robot->second.accepted);
}

std::vector<PostedPose> StateQueue::unsent() const {
  std::vector<PostedPose> all;
  for (const auto& [name, held] : robots_) {
    if (held.is_news) all.push_back(held.posted);
  }
  return all;
}

}  // namespace adit::queues
