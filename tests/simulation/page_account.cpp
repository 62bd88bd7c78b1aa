#include "simulation/page_account.hpp"

#include <algorithm>

#include "simulation/asked.hpp"
#include "simulation/checks.hpp"
#include "simulation/courses.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/messages.hpp"
#include "simulation/upstream_view.hpp"

namespace adit::simulation {
namespace {

constexpr double kRecorded = 2;  // seconds until a process records when a robot was last heard
constexpr double kRestored = 3;  // seconds by which an age may be too high after a restart

}  // namespace

std::string endpoint_of(const std::string& path) {
  return path == kReports || path == kStatus ? "scoring" : "mapping";
}

Stream stream_of(const std::string& path, const std::string& who) {
  return {path, path == kMarkers ? "" : who};
}

PageAccount::PageAccount(const std::vector<Event>& events) : events_(events) {
  double ended = 0;
  DiskFaultsSeen disk;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    if (event.kind == Kind::Ended || event.kind == Kind::Dies) ended = event.at;
    // A process that stands still for its disk records nothing in that time.
    const bool forgets = disk.forgets_at(event) || event.kind == Kind::PowerCut || event.kind == Kind::Slow;
    if (forgets || event.what == kCourse) forgotten_.push_back(i);
    if (event.kind == Kind::Invoke && event.what == kSendRejected) sent_again_.push_back(i);
    disk.add(event);
    // A gateway that begins listens.
    const bool begins = event.kind == Kind::Begins ||
                        (event.kind == Kind::Said && event.text.starts_with("notice: listening"));
    if (begins || event.what == kCourse) {  // or asks another Command Post
      begun_.push_back(i);
      recorded_until_.push_back(ended - kRecorded);
      for (auto& [stream, delivered] : delivered_) delivered.is_of_before = true;
    }
    end_forgotten(i, event);
    read_team(i, event);
    read_upstream(i, event);
  }
}

void PageAccount::read_team(std::size_t place, const Event& event) {
  const bool is_of_a_kind = event.what == kState || event.what == kMap || event.what == kMarkers;
  if (event.actor != Actor::Team || !is_of_a_kind) return;
  const Stream stream = stream_of(event.what, event.who);
  if (event.kind == Kind::Invoke) {
    if (event.what == kState) {
      ++poses_[{stream, event.serial}];
      posted_at_.try_emplace({stream, event.serial}, event.at);
    }
    auto& all = posted_[stream];
    auto& open = open_[event.request];
    // A message of several markers or clouds counts once. Each pose of a state counts separately.
    if (event.what != kState && !open.empty()) return;
    open.emplace_back(stream, all.size());
    all.push_back({.asked = place});
  }
  if (event.kind == Kind::Gone) gone_.emplace_back(event.at, event.request);
  if (event.kind == Kind::Answered) end(place, event);
}

/// A request may be accepted for a while after its client is gone.
void PageAccount::end_forgotten(std::size_t place, const Event& event) {
  while (!gone_.empty() && gone_.front().first + kForgotten < event.at) {
    end(place, {.what = "", .who = "", .request = gone_.front().second});
    gone_.pop_front();
  }
}

void PageAccount::end(std::size_t place, const Event& event) {
  for (const auto& [whose, which] : open_[event.request]) {
    Posted& posted = posted_[whose][which];
    posted.ended = std::min(posted.ended, place);
    posted.status = event.status;
  }
}

void PageAccount::read_upstream(std::size_t place, const Event& event) {
  if (event.kind == Kind::Leaves) under_way_[event.request].clear();
  if (event.kind == Kind::Left) {
    const std::int64_t pose = event.what == kState ? event.serial : 0;
    under_way_[event.request].try_emplace(stream_of(event.what, event.who), pose);
  }
  if (event.kind != Kind::Replied) return;
  const bool is_page = event.who == kForeign || event.who == kTooLong;
  const std::string endpoint = endpoint_of(event.what);
  if (event.status == 429) throttled_[endpoint].push_back(place);
  const bool never = event.status >= 300 && event.status < 400;
  const bool is_size = event.status == 413 && event.what != kReports && event.what != kStatus;
  const bool allowed = event.status == 404 || event.status == 429 || event.status >= 500 || is_size;
  const bool is_no_run =
      event.what == kStatus && event.status >= 200 && event.status < 300 && event.says.empty();  // ICD 5.1
  if ((never && event.who != kOtherForm) || is_no_run || (is_page && !allowed))
    foreign_[endpoint].push_back(place);
  if (event.status >= 300 || is_page) return;
  for (const auto& [stream, pose] : under_way_[event.request]) count_delivery(place, stream, pose);
}

/// A pose counts when it is new. A pose that was delivered before is new only if it was posted again
/// meanwhile.
void PageAccount::count_delivery(std::size_t place, const Stream& stream, std::int64_t pose) {
  Delivered& delivered = delivered_[stream];
  if (stream.path != kState || delivered.pose != pose) {
    delivered = {.pose = pose, .times = 1};
    const auto posted = posted_at_.find({stream, pose});
    age_from_[{stream, place}] = posted == posted_at_.end() ? events_[place].at : posted->second;
    return forwarded_[stream].push_back(place);
  }
  if (!delivered.is_of_before && delivered.times >= poses_[{stream, pose}]) return;
  ++delivered.times;
  may_be_forwarded_[stream].push_back(place);
}

Range PageAccount::accepted(const Stream& stream, Moment from, Moment to) const {
  Range range;
  const auto found = posted_.find(stream);
  if (found == posted_.end()) return range;
  for (const Posted& each : found->second) {
    if (each.asked >= from.heard && each.status == 200 && each.ended < to.asked) ++range.least;
    const bool refused = each.status >= 300;
    if (each.asked < to.heard && each.ended >= from.asked && !refused) ++range.most;
  }
  return range;
}

Range PageAccount::between(const Places& places, Moment from, Moment to) {
  const auto count = [&](std::size_t first, std::size_t end) {
    return std::ranges::count_if(places, [&](std::size_t each) { return each >= first && each < end; });
  };
  return {count(from.heard, to.asked), count(from.asked, to.heard)};
}

Range PageAccount::forwarded(const Stream& stream, Moment from, Moment to) const {
  const auto places = [&](const std::map<Stream, Places>& all) {
    const auto found = all.find(stream);
    return found == all.end() ? Range{} : between(found->second, from, to);
  };
  const Range sure = places(forwarded_);
  return {sure.least, sure.most + places(may_be_forwarded_).most};
}

PageAccount::Age PageAccount::age(const Stream& stream, Moment at) const {
  const auto last = [&](const std::map<Stream, Places>& all, std::size_t before) {
    const auto found = all.find(stream);
    if (found == all.end()) return kNever;
    const auto after = std::ranges::lower_bound(found->second, before);
    return after == found->second.begin() ? kNever : *std::prev(after);
  };
  Age age{.least = std::numeric_limits<double>::infinity()};
  for (const auto* const all : {&forwarded_, &may_be_forwarded_}) {
    const std::size_t any = last(*all, at.heard);
    if (any != kNever) age.least = std::min(age.least, std::max(0.0, events_[at.asked].at - events_[any].at));
  }
  const auto since = [&](std::size_t sure) {
    return events_[at.heard - 1].at - age_from_.at({stream, sure});
  };
  const std::size_t start = begun(at);
  std::size_t sure = last(forwarded_, at.asked);
  const bool is_restored =
      sure != kNever && sure >= start && age_from_.at({stream, sure}) < events_[start].at;
  const auto again = std::ranges::lower_bound(sent_again_, start);
  // A rejected message has no time of its own.
  if (is_restored && again != sent_again_.end() && *again < sure) sure = last(forwarded_, start);
  if (sure == kNever) return age;
  if (sure >= start) {
    age.most = since(sure) + (is_restored ? kRestored : 0);
    return age;
  }
  // A restart loses no recorded time.
  const auto is_recorded = [&](std::size_t place) {
    const auto next = std::ranges::upper_bound(begun_, place) - begun_.begin();
    return events_[place].at <= recorded_until_[static_cast<std::size_t>(next)];
  };
  while (sure != kNever && !is_recorded(sure)) sure = last(forwarded_, sure);
  const auto forgotten = std::ranges::lower_bound(forgotten_, at.heard);
  const bool is_forgotten = forgotten != forgotten_.begin() && sure < *std::prev(forgotten);
  if (sure != kNever && !is_forgotten) age.most = since(sure) + kRestored;
  return age;
}

Range PageAccount::throttled(const std::string& endpoint, Moment from, Moment to) const {
  const auto found = throttled_.find(endpoint);
  return found == throttled_.end() ? Range{} : between(found->second, from, to);
}

Range PageAccount::foreign(const std::string& endpoint, Moment from, Moment to) const {
  const auto found = foreign_.find(endpoint);
  return found == foreign_.end() ? Range{} : between(found->second, from, to);
}

std::size_t PageAccount::begun(Moment at) const {
  const auto after = std::ranges::upper_bound(begun_, at.heard);
  return after == begun_.begin() ? 0 : *std::prev(after);
}

}  // namespace adit::simulation
