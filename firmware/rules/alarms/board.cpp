#include "alarms/board.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/try.hpp"

namespace adit::alarms {
namespace {

using codec::member;
using codec::Value;

constexpr std::int64_t kVersion = 1;

constexpr codec::Member kMembers[] = {
    member<&Acknowledgement::id>("id"),         member<&Acknowledgement::severity>("severity"),
    member<&Acknowledgement::degree>("degree"), member<&Acknowledgement::what>("what"),
    member<&Acknowledgement::why>("why"),       member<&Acknowledgement::at>("at", "seconds since 1970"),
};

}  // namespace

constexpr codec::Row Acknowledgement::kRow = codec::complete<Acknowledgement>({"", kMembers});

std::string write_acknowledged(const std::vector<Acknowledgement>& all) {
  return codec::write_json({Value::Object{{"version", {kVersion}}, {"acknowledged", codec::json(all)}}}) +
         '\n';
}

std::expected<std::vector<Acknowledgement>, std::string> read_acknowledged(std::string_view json) {
  const auto root = ADIT_TRY(codec::parse_json(json));
  codec::Reading reading;
  const codec::Field file(root, reading);
  const codec::Field version = file.member("version");
  if (version.integer<std::int64_t>() != kVersion) version.refuse("expected ", kVersion);
  std::vector<Acknowledgement> all;
  codec::KindOf<std::vector<Acknowledgement>>::read(file.member("acknowledged"), all);
  const auto read = reading.outcome(true);
  if (!read) return std::unexpected(read.error().sentence);
  if (all.size() > Acknowledgement::kMost) return std::unexpected("acknowledged: too many");
  return all;
}

bool Board::is_worse(const Condition& condition, const KnownCondition& known) {
  return condition.severity < known.seen.severity || condition.degree > known.seen.degree;
}

EndedAlarm Board::to_ended(const KnownCondition& known, double now) {
  const Condition& condition = known.worst;
  return {.id = condition.id,
          .severity = condition.severity,
          .side = condition.side,
          .was = condition.headline.past(),
          .since = known.worst_since,
          .until = now};
}

void Board::acknowledge_as_shown(KnownCondition& known, double now) {
  const Condition& condition = known.condition;
  known.acknowledged = true;
  known.seen = {.id = condition.id,
                .severity = condition.severity,
                .degree = condition.degree,
                .what = condition.headline.now(),
                .why = condition.why,
                .at = now};
}

void Board::update(const std::vector<Condition>& conditions, double now) {
  std::set<std::string_view> here;
  for (const Condition& condition : conditions) {
    here.insert(condition.id);
    const auto [place, came] = known_.try_emplace(condition.id);
    KnownCondition& known = place->second;
    if (came || condition.severity != known.condition.severity)
      known.since = condition.since > 0 ? condition.since : now;
    if (came || condition.severity < known.worst.severity) known.worst_since = known.since;
    if (known.acknowledged && is_worse(condition, known)) known.acknowledged = false;
    known.condition = condition;
    const bool is_better =
        condition.severity > known.worst.severity ||
        (condition.severity == known.worst.severity && condition.degree < known.worst.degree);
    if (came || !is_better) known.worst = condition;
    if (known.acknowledged && condition.degree < known.seen.degree)
      acknowledge_as_shown(known, known.seen.at);
  }
  for (auto each = known_.begin(); each != known_.end();) {
    if (here.contains(each->first)) {
      ++each;
      continue;
    }
    over_.push_front(to_ended(each->second, now));
    if (over_.size() > kMostOver) over_.pop_back();
    std::erase_if(before_, [&](const Acknowledgement& before) { return before.id == each->first; });
    each = known_.erase(each);
  }
  restore_acknowledged(conditions, now);
}

void Board::remember(std::vector<Acknowledgement> before, double now) {
  before_ = std::move(before);
  std::erase_if(before_, [now](const Acknowledgement& each) {
    return each.at > now || now - each.at > Acknowledgement::kHolds;
  });
  waits_until_ = now + Acknowledgement::kWaitsFor;
}

void Board::restore_acknowledged(const std::vector<Condition>& conditions, double now) {
  if (now > waits_until_) before_.clear();
  for (const Condition& condition : conditions) {
    const auto before = std::ranges::find(before_, condition.id, &Acknowledgement::id);
    if (before == before_.end()) continue;
    KnownCondition& known = known_.at(condition.id);
    const bool worse = condition.severity < before->severity || condition.degree > before->degree;
    const bool same = condition.severity == before->severity && condition.degree == before->degree &&
                      condition.headline.now() == before->what && condition.why == before->why;
    if (same) acknowledge_as_shown(known, before->at);
    if (same || worse || known.acknowledged) before_.erase(before);
  }
}

std::vector<Acknowledgement> Board::acknowledgements() const {
  std::vector<Acknowledgement> all = before_;
  for (const auto& [id, known] : known_) {
    const bool fits = known.seen.what.size() + known.seen.why.size() <= Acknowledgement::kLongest;
    if (known.acknowledged && fits && all.size() < Acknowledgement::kMost) all.push_back(known.seen);
  }
  return all;
}

void Board::move(double seconds) {
  for (auto& [id, known] : known_) {
    known.since += seconds;
    known.worst_since += seconds;
    known.seen.at += seconds;
  }
  for (Acknowledgement& before : before_) before.at += seconds;
  waits_until_ += seconds;
  for (EndedAlarm& over : over_) {
    over.since += seconds;
    over.until += seconds;
  }
}

std::expected<void, std::string> Board::acknowledge(const std::string& id, double now) {
  const auto found = known_.find(id);
  if (found == known_.end()) return std::unexpected("there is no such alarm any more");
  acknowledge_as_shown(found->second, now);
  return {};
}

std::vector<Alarm> Board::to_alarms(const std::vector<Condition>& conditions, double now) const {
  std::vector<Alarm> alarms;
  alarms.reserve(conditions.size());
  for (const Condition& condition : conditions) {
    const auto found = known_.find(condition.id);
    const bool known = found != known_.end();
    double since = condition.since > 0 ? condition.since : now;
    if (known) since = found->second.since;
    const std::string why = reason_of(condition.why);
    alarms.push_back(
        {.id = condition.id,
         .severity = condition.severity,
         .side = condition.side,
         .subject = condition.subject,
         .since = since,
         .what = condition.headline.now(),
         .why = why,
         .details = why == condition.why ? "" : condition.why,
         .action = condition.action,
         .acknowledged = known && found->second.acknowledged && !is_worse(condition, found->second),
         .hides = condition.hides});
  }
  std::ranges::stable_sort(alarms, {},
                           [](const Alarm& alarm) { return std::tuple(alarm.severity, alarm.since); });
  return alarms;
}

}  // namespace adit::alarms
