#include "alarms/habits.hpp"

#include <algorithm>
#include <utility>

#include "icd/status.hpp"

namespace adit::alarms {

using facts::EndpointFault;
using facts::EndpointRow;

namespace {

constexpr double kNew = 0.25;  // weight of the last gap

}  // namespace

void Growth::update(std::size_t bytes, std::size_t room, double now) {
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
  KnownRobot& known = known_.try_emplace(robot, KnownRobot{.habit = {.last = now}}).first->second;
  if (known.habit.messages > 1 || std::exchange(known.was_expected, true)) return;
  known.habit.messages = kMessages;
  known.is_expected = true;
}

void Habits::restore(const std::string& robot, const Habit& habit, std::uint64_t count) {
  if (has_room(habit.last)) known_[robot] = {.count = count, .habit = habit, .was_expected = true};
}

void Habits::on_count(const std::string& robot, std::uint64_t count, double now) {
  if (robot.empty()) return;
  auto place = known_.find(robot);
  if (place == known_.end()) {
    if (has_room(now))
      known_.emplace(robot, KnownRobot{.count = count, .habit = {.messages = 1, .last = now}});
    return;
  }
  KnownRobot& known = place->second;
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

std::optional<Habit> Habits::habit_of(const std::string& robot) const {
  const auto known = known_.find(robot);
  return known == known_.end() ? std::nullopt : std::optional(known->second.habit);
}

facts::Habits Habits::robots(const Rules& rules, double now) const {
  facts::Habits robots;
  for (const auto& [name, known] : known_) {
    const auto& [messages, gap, last] = known.habit;
    const double quiet = now - last;
    if (messages < kMessages || quiet > rules.away) continue;
    const bool silent = quiet > std::max(rules.least, rules.times * gap);
    robots[name] = {.gap = gap, .quiet = quiet, .silent = silent};
  }
  return robots;
}

namespace {

bool is_barred(const ConnectionSample& seen) {
  return seen.foreign || seen.status == 401 || seen.status == 403;
}

/// Whether the status concerns the endpoint rather than one message.
bool is_error(int status) {
  return status >= 500 || status == 404 || status == 405 || status == 407;
}

void begin(std::optional<double>& since, bool so, double now) {
  if (!so) since.reset();
  if (so && !since) since = now;
}

}  // namespace

void EndpointWatch::update(ConnectionState& way, const ConnectionSample& seen, double now) {
  const bool ended = seen.ended != way.seen.ended;
  const bool answered = ended && seen.status != 0;
  const bool moved = seen.sent != way.seen.sent;
  if (answered && !is_barred(seen) && !is_error(seen.status) && seen.status != icd::kTooManyRequests) {
    way.well = now;
    way.failing.reset();
  }
  if (answered) begin(way.barred, is_barred(seen), now);
  if (answered && is_error(seen.status) && !seen.foreign && !way.failing) way.failing = now;
  const bool came_to_nothing = seen.status == 0 && !seen.said.empty();
  const bool unanswered = seen.busy || came_to_nothing;
  // After a failed request, bytes of the next one are no sign of life.
  if (answered || (moved && !came_to_nothing)) way.waits.reset();
  begin(way.waits, unanswered, now);
  begin(way.without, !seen.connected && seen.status == 0 && !seen.said.empty(), now);
  for (std::uint64_t i = way.seen.throttled; i < seen.throttled && i < way.seen.throttled + kThrottled; ++i)
    throttled_.push_back(now);
  while (throttled_.size() > kThrottled) throttled_.pop_front();
  way.seen = seen;
}

void EndpointWatch::update(const std::vector<ConnectionSample>& seen, double now) {
  if (ways_.size() != seen.size()) {
    ways_.assign(seen.size(), {});
    for (std::size_t i = 0; i < seen.size(); ++i) {
      ways_[i].seen.ended = seen[i].ended;
      ways_[i].seen.throttled = seen[i].throttled;
    }
  }
  for (std::size_t i = 0; i < seen.size(); ++i) update(ways_[i], seen[i], now);
  const bool was_stopped = std::exchange(is_stopped_, endpoint(now).fault < EndpointFault::Throttling);
  if (was_stopped && !is_stopped_) well_since_ = now;
}

void EndpointWatch::forget() {
  ways_.clear();
  throttled_.clear();
  is_stopped_ = true;  // so that messages queued for the old address count as late, not as failed
}

/// Whether another connection had a good answer within kStillWell, and not before `since` less a second.
bool EndpointWatch::is_well_elsewhere(const ConnectionState& way, double since, double now) const {
  return std::ranges::any_of(ways_, [&](const ConnectionState& other) {
    return &other != &way && other.well && *other.well > std::min(since, now) - 1 &&
           now - *other.well < kStillWell;
  });
}

EndpointRow EndpointWatch::endpoint_row(const ConnectionState& way, double now) const {
  const ConnectionSample& seen = way.seen;
  const auto lasts = [&](const std::optional<double>& since, double seconds) {
    return since && now - *since >= seconds && !is_well_elsewhere(way, *since, now);
  };
  if (lasts(way.without, kUnreachableAfter))
    return {.fault = EndpointFault::Unreachable, .since = *way.without, .said = seen.said};
  const bool was_well = std::ranges::any_of(ways_, [](const auto& each) { return each.well.has_value(); });
  const bool may_be_a_robot = has_robots_ && was_well && !seen.foreign;
  if (lasts(way.barred, may_be_a_robot ? kFailingAfter : 0)) {
    return {.fault = seen.foreign ? EndpointFault::Foreign : EndpointFault::Refusing,
            .since = *way.barred,
            .said = seen.said};
  }
  if (lasts(way.waits, kSilentAfter)) return {.fault = EndpointFault::Silent, .since = *way.waits};
  if (lasts(way.failing, kFailingAfter))
    return {.fault = EndpointFault::Failing, .since = *way.failing, .said = seen.said};
  return {};
}

EndpointRow EndpointWatch::throttling(double now) const {
  if (throttled_.size() < kThrottled || now - throttled_.front() > kThrottledWithin) return {};
  return {.fault = EndpointFault::Throttling, .since = throttled_.front()};
}

EndpointRow EndpointWatch::endpoint(double now) const {
  EndpointRow worst = throttling(now);
  double longest = 0;
  for (const ConnectionState& way : ways_) {
    const EndpointRow other = endpoint_row(way, now);
    const double waits = way.waits && !is_well_elsewhere(way, *way.waits, now) ? now - *way.waits : 0;
    if (other.fault < worst.fault) worst = other;
    longest = std::max(longest, waits);
  }
  worst.waits = longest;
  if (well_since_ && worst.fault >= EndpointFault::Throttling) worst.well_for = now - *well_since_;
  return worst;
}

}  // namespace adit::alarms
