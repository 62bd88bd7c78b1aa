#include "alarms/board.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "alarms/words.hpp"

namespace adit::alarms {

bool Board::is_worse(const Condition& condition, const Known& known) {
  return condition.severity < known.seen_as || condition.degree > known.seen_degree;
}

Over Board::over(const Known& known, double now) {
  const Condition& condition = known.condition;
  return {.id = condition.id,
          .severity = condition.severity,
          .side = condition.side,
          .was = past(condition.what),
          .since = known.since,
          .until = now};
}

void Board::take(const std::vector<Condition>& conditions, double now) {
  std::set<std::string_view> here;
  for (const Condition& condition : conditions) {
    here.insert(condition.id);
    const auto [place, came] = known_.try_emplace(condition.id);
    Known& known = place->second;
    if (came) known.since = condition.since > 0 ? condition.since : now;
    if (known.acknowledged && is_worse(condition, known)) known.acknowledged = false;
    known.condition = condition;
  }
  for (auto each = known_.begin(); each != known_.end();) {
    if (here.contains(each->first)) {
      ++each;
      continue;
    }
    over_.push_front(over(each->second, now));
    if (over_.size() > kMostOver) over_.pop_back();
    each = known_.erase(each);
  }
}

std::expected<void, std::string> Board::acknowledge(const std::string& id) {
  const auto found = known_.find(id);
  if (found == known_.end()) return std::unexpected("there is no such alarm any more");
  found->second.acknowledged = true;
  found->second.seen_as = found->second.condition.severity;
  found->second.seen_degree = found->second.condition.degree;
  return {};
}

std::vector<Alarm> Board::shown(const std::vector<Condition>& conditions, double now) const {
  std::vector<Alarm> alarms;
  alarms.reserve(conditions.size());
  for (const Condition& condition : conditions) {
    const auto found = known_.find(condition.id);
    const bool known = found != known_.end();
    const double since = known ? found->second.since : condition.since > 0 ? condition.since : now;
    alarms.push_back(
        {.id = condition.id,
         .severity = condition.severity,
         .side = condition.side,
         .subject = condition.subject,
         .since = since,
         .what = condition.what,
         .why = condition.why,
         .action = condition.action,
         .acknowledged = known && found->second.acknowledged && !is_worse(condition, found->second),
         .hides = condition.hides});
  }
  std::ranges::stable_sort(alarms, {},
                           [](const Alarm& alarm) { return std::tuple(alarm.severity, alarm.since); });
  return alarms;
}

}  // namespace adit::alarms
