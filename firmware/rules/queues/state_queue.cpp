#include "queues/state_queue.hpp"

#include <algorithm>
#include <utility>

namespace adit::queues {

std::size_t StateQueue::unknown_in(const auto& poses) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(poses, [this](const auto& pose) { return !robots_.contains(pose.name); }));
}

bool StateQueue::has_room_for(const icd::StateUpdate& update) const {
  const std::size_t unknown = unknown_in(update.poses);
  if (unknown == 0 || robots_.size() + unknown <= kMostRobots) return true;
  const auto waiting = std::ranges::count_if(robots_, &Held::waits, &Robots::value_type::second);
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
  if (robots_.size() + unknown_in(news) > kMostRobots) forget_what_was_taken();
  for (const PostedPose& newer : news) {
    Held& held = robots_.try_emplace(newer.name, Held{newer}).first->second;
    held.posted = newer;
    held.is_news = held.is_of_run = true;
    held.is_given_up = false;
  }
  oldest_ = std::min(oldest_.value_or(now), now);
}

void StateQueue::forget_what_was_taken() {
  std::erase_if(robots_, [](const auto& robot) { return !robot.second.waits(); });
}

void StateQueue::begin_run() {
  for (auto& [name, held] : robots_) held.is_of_run = false;
}

void StateQueue::add_unless_known(const icd::StateUpdate& update, Instant now) {
  for (const icd::NamedPose& named : update.poses) {
    const auto [robot, is_new] = robots_.try_emplace(named.name, Held{{named.name, named.pose}});
    Held& held = robot->second;
    if (!is_new && !std::exchange(held.is_given_up, false)) continue;
    held.is_news = true;
    held.trial = {};
    oldest_ = std::min(oldest_.value_or(now), now);
  }
}

/// The robot that goes apart, has news, and failed longest ago. Robots that do not rest come first.
StateQueue::Robots::iterator StateQueue::next_apart(Instant now) {
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

void StateQueue::include(QueuedState& taken, Robots::value_type& robot) {
  const PostedPose& posted = robot.second.posted;
  robot.second.is_under_way = std::exchange(robot.second.is_news, false);
  taken.update.poses.push_back(posted.named());
  if (robot.second.is_under_way) taken.news.push_back(posted.named());
  taken.update.header.stamp = std::max(taken.update.header.stamp, posted.stamp);
}

std::optional<QueuedState> StateQueue::take(Instant now) {
  if (!oldest_) return {};
  QueuedState taken{.update = {}, .news = {}, .accepted = *oldest_};
  const auto together = [](const auto& robot) { return !robot.second.apart; };
  const bool others_have_news = std::ranges::any_of(
      robots_, [&](const auto& robot) { return together(robot) && robot.second.is_news; });
  const auto apart = next_apart(now);
  if (apart != robots_.end() && (!others_have_news || !apart->second.trial.rests(now))) {
    include(taken, *apart);
  } else {
    for (auto& robot : robots_) {
      if (together(robot) && robot.second.goes()) include(taken, robot);
    }
  }
  for (auto& [name, held] : robots_) held.trial.steps_behind = false;
  if (std::ranges::none_of(robots_, [](const auto& robot) { return robot.second.is_news; })) oldest_.reset();
  return taken;
}

void StateQueue::put_back(const QueuedState& state) {
  // All poses that were news are still held.
  for (const icd::NamedPose& pose : state.update.poses) {
    const auto held = robots_.find(pose.name);
    if (held != robots_.end() && std::exchange(held->second.is_under_way, false)) held->second.is_news = true;
  }
  oldest_ = std::min(oldest_.value_or(state.accepted), state.accepted);
}

void StateQueue::put_back_apart(const QueuedState& state) {
  put_back(state);
  for (const icd::NamedPose& pose : state.update.poses) {
    if (const auto held = robots_.find(pose.name); held != robots_.end()) held->second.apart = true;
  }
}

void StateQueue::passed(const QueuedState& state) {
  for (const icd::NamedPose& pose : state.update.poses) {
    const auto held = robots_.find(pose.name);
    if (held == robots_.end()) continue;
    held->second.apart = held->second.is_given_up = held->second.is_under_way = false;
    held->second.trial = {};
  }
}

void StateQueue::give_up(const icd::RobotName& name, Instant now) {
  Held& held = robots_.at(name);
  held.apart = held.is_given_up = true;
  held.is_under_way = false;
  held.trial = {};
  held.trial.rests_until = now + kRest;
}

std::vector<PostedPose> StateQueue::unsent() const {
  std::vector<PostedPose> all;
  for (const auto& [name, held] : robots_) {
    if (held.is_news) all.push_back(held.posted);
  }
  return all;
}

}  // namespace adit::queues
