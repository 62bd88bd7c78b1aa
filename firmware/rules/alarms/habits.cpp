#include "alarms/habits.hpp"

#include <algorithm>
#include <utility>

namespace adit::alarms {
namespace {

constexpr double kNew = 0.25;  // weight of the last gap

}  // namespace

void Growth::look(std::size_t bytes, std::size_t room, double now) {
  if (!begun_ || now - step_at_ >= kStep) {
    begun_ = true;
    step_at_ = now;
    least_.push_back(bytes);
    if (least_.size() > kSteps + 1) least_.pop_front();
    const bool rises = least_.size() > kSteps && std::ranges::is_sorted(least_, std::ranges::less_equal{});
    if (rises && static_cast<double>(bytes) > kTelling * static_cast<double>(room)) {
      grew_ = true;
      last_ = now;
    }
  }
  least_.back() = std::min(least_.back(), bytes);
}

/// Removes robots that were switched off if the table is full.
bool Habits::has_room(double now) {
  if (known_.size() < kMost) return true;
  std::erase_if(known_, [now](const auto& each) { return now - each.second.habit.last > Rules{}.away; });
  return known_.size() < kMost;
}

void Habits::expect(const std::string& robot, double now) {
  if (!known_.contains(robot) && !has_room(now)) return;
  Known& known = known_.try_emplace(robot, Known{.habit = {.last = now}}).first->second;
  if (known.habit.messages > 1 || std::exchange(known.was_expected, true)) return;
  known.habit.messages = kMessages;
  known.is_expected = true;
}

void Habits::carry_on(const std::string& robot, const Habit& habit, std::uint64_t count) {
  if (has_room(habit.last)) known_[robot] = {.count = count, .habit = habit, .was_expected = true};
}

void Habits::heard(const std::string& robot, std::uint64_t count, double now) {
  if (robot.empty()) return;
  auto place = known_.find(robot);
  if (place == known_.end()) {
    if (has_room(now)) known_.emplace(robot, Known{.count = count, .habit = {.messages = 1, .last = now}});
    return;
  }
  Known& known = place->second;
  if (count == known.count) return;
  if (known.is_expected) {
    known = {.count = count, .habit = {.messages = 1, .last = now}, .was_expected = true};
    return;
  }
  auto& [messages, usual, last] = known.habit;
  const double gap = now - last;
  // A returning robot starts without a habit, because its absence would distort the average.
  const bool was_away = messages >= kMessages && gap > std::max(60.0, 10 * usual);
  messages = was_away ? 1 : messages + 1;
  if (messages == 2) usual = gap;
  if (messages > 2) usual = std::max(usual + kNew * (gap - usual), gap / 2);
  known.count = count;
  last = now;
}

std::optional<Habit> Habits::of(const std::string& robot) const {
  const auto known = known_.find(robot);
  return known == known_.end() ? std::nullopt : std::optional(known->second.habit);
}

std::map<std::string, Robot> Habits::robots(const Rules& rules, double now) const {
  std::map<std::string, Robot> robots;
  for (const auto& [name, known] : known_) {
    const auto& [messages, gap, last] = known.habit;
    const double quiet = now - last;
    if (messages < kMessages || quiet > rules.away) continue;
    const bool silent = quiet > std::max(rules.least, rules.times * gap);
    robots[name] = {.gap = gap, .quiet = quiet, .silent = silent};
  }
  return robots;
}

}  // namespace adit::alarms
