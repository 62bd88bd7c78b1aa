#include "alarms/habits.hpp"

#include <algorithm>
#include <utility>

namespace adit::alarms {
namespace {

constexpr double kNew = 0.25;  // what the last gap says of the habit

}  // namespace

void Habits::expect(const std::string& robot, double now) {
  if (known_.size() >= kMost && !known_.contains(robot)) return;
  Known& known = known_.try_emplace(robot, Known{.last = now}).first->second;
  if (known.messages > 1 || std::exchange(known.was_expected, true)) return;
  known.messages = kMessages;
  known.is_expected = true;
}

void Habits::heard(const std::string& robot, std::uint64_t count, double now) {
  if (robot.empty()) return;
  auto place = known_.find(robot);
  if (place == known_.end()) {
    if (known_.size() >= kMost) return;
    known_.emplace(robot, Known{.count = count, .messages = 1, .last = now});
    return;
  }
  Known& known = place->second;
  if (count == known.count) return;
  if (known.is_expected) {
    known = {.count = count, .messages = 1, .last = now, .was_expected = true};
    return;
  }
  const double gap = now - known.last;
  // A robot that comes back begins from nothing, for a silence is no habit.
  const bool was_away = known.messages >= kMessages && gap > std::max(60.0, 10 * known.gap);
  known.messages = was_away ? 1 : known.messages + 1;
  if (known.messages == 2) known.gap = gap;
  if (known.messages > 2) known.gap = std::max(known.gap + kNew * (gap - known.gap), gap / 2);
  known.count = count;
  known.last = now;
}

std::map<std::string, Robot> Habits::robots(const Rules& rules, double now) const {
  std::map<std::string, Robot> robots;
  for (const auto& [name, known] : known_) {
    const double quiet = now - known.last;
    if (known.messages < kMessages || quiet > rules.away) continue;
    const bool silent = quiet > std::max(rules.least, rules.times * known.gap);
    robots[name] = {.gap = known.gap, .quiet = quiet, .silent = silent};
  }
  return robots;
}

}  // namespace adit::alarms
