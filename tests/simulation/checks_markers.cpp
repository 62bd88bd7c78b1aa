// PoseArrived and MarkersArrived: the value of each name at rest.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "icd/sentence.hpp"
#include "simulation/asked.hpp"
#include "simulation/checks.hpp"
#include "simulation/courses.hpp"
#include "simulation/messages.hpp"
#include "simulation/scoreboard.hpp"

namespace adit::simulation {
namespace {

constexpr double kOneClock = 1;  // seconds by which stamps of one clock may differ
/// Seconds. A clock was certainly set back if it has run on for kSteady, with no message more than kJitter
/// late.
constexpr double kSteady = 5, kJitter = 0.9;

/// Seconds: until a message leaves on a new connection; the least lifetime that is sent; a rounding.
constexpr double kConnects = 4, kLeastLifetime = 0.1, kLeastStep = 0.002, kSoonAfter = 0.1;

/// A request that may have set a value, and when.
struct Change {
  double began, ended, stamp;
  bool accepted;
  std::int64_t serial;  // 0: the value was deleted
  Says sender = {};
  bool fades = false;            // by its lifetime
  const Asked* asked = nullptr;  // of a marker
  Item item = {};
  double late = 0;  // seconds from its stamp to its post, of a backlog

  bool is_of_one_clock(const Change& other) const {
    return stamp != 0 && other.stamp != 0 && sender == other.sender &&
           std::abs((stamp + late - began) - (other.stamp + other.late - other.began)) < kOneClock;
  }
};
using Changes = std::vector<Change>;

/// Whether `other` certainly came after `change`. Stamps decide if one clock made both, unless a pose of
/// another clock may have come between them and replaced the first, or the gateway may have forgotten the
/// first. Otherwise the times of the posts decide.
bool is_before(const Change& change, const Change& other, const Changes& all,
               const std::vector<double>& forgets) {
  const bool by_stamps = change.stamp < other.stamp;
  const bool by_arrival =
      change.ended < other.began || (change.asked != nullptr && other.asked != nullptr &&
                                     is_overtaken(*change.asked, change.item, *other.asked, other.item));
  if (!change.is_of_one_clock(other) || by_stamps == by_arrival) return by_arrival;
  const double from = std::min(change.began, other.began), to = std::max(change.ended, other.ended);
  const double first_ended = change.began < other.began ? change.ended : other.ended;
  const bool is_apart =
      std::ranges::any_of(forgets, [&](double at) { return at > first_ended && at < to; }) ||
      std::ranges::any_of(all, [&](const Change& third) {
        return !third.is_of_one_clock(change) && third.ended > from && third.began < to;
      });
  if (is_apart) return by_arrival;
  // The process before may have accepted the first one, or the next one.
  const bool is_unsure =
      std::ranges::any_of(forgets, [&](double at) { return at > from && at <= first_ended; });
  return by_stamps && !is_unsure;
}

/// Whether `early` may have replaced `late`, which was posted after it, because its stamp is later. That is
/// allowed until the client's clock has certainly run on since it was set back (`queues/stamps.hpp`).
bool seems_overtaken(const Change& late, const Change& early, const Changes& all,
                     const std::vector<double>& forgets) {
  if (late.stamp == 0 || late.stamp >= early.stamp) return false;
  const auto keeps_time = [&](const Change& first, const Change& each) {
    const bool is_between = each.ended >= first.began && each.began <= late.ended;
    if (!is_between || each.sender != first.sender) return true;
    return each.accepted && each.stamp != 0 && each.late == 0 && each.stamp < early.stamp &&
           std::abs((each.ended - each.stamp) - (first.began - first.stamp)) < kJitter;
  };
  return std::ranges::none_of(all, [&](const Change& first) {
    return early.ended < first.began && first.stamp < early.stamp && late.stamp - first.stamp >= kSteady &&
           std::ranges::none_of(
               forgets, [&](double at) { return at > first.began && at < late.ended; }) &&
           std::ranges::all_of(all, [&](const Change& each) { return keeps_time(first, each); });
  });
}

/// Whether a backlog ran as a clock does for so long that Adit may take it for the client's clock.
bool may_set_clock(const Change& change, const Changes& all) {
  constexpr double kFasterBy = 1.5;  // seconds in kSteady, at most
  return change.late > 0 && std::ranges::any_of(all, [&](const Change& first) {
           return first.late > 0 && first.sender == change.sender && first.began < change.began &&
                  change.stamp - first.stamp >= kSteady - kJitter && change.late > first.late - kFasterBy;
         });
}

/// The values that may remain at the end: those of changes that no accepted change followed. `forgets`:
/// times at which the gateway may have lost its values.
std::set<std::int64_t> last_of(const Changes& changes, const std::vector<double>& forgets = {}) {
  std::set<std::int64_t> last;
  bool any = false;
  for (const Change& change : changes) {
    const bool may_stay = may_set_clock(change, changes);
    bool over = false;
    for (const Change& other : changes)
      over = over || (other.accepted && !(may_stay && other.began < change.began) &&
                      is_before(change, other, changes, forgets) &&
                      !seems_overtaken(other, change, changes, forgets));
    if (!over) last.insert(change.serial);
    if (!over && change.fades) last.insert(0);
    any = any || change.accepted;
  }
  if (!any) last.insert(0);
  return last;
}

std::string list_of(const std::set<std::int64_t>& serials) {
  std::string list;
  for (const std::int64_t serial : serials)
    list += (list.empty() ? "" : " or ") + (serial == 0 ? "none" : std::to_string(serial));
  return list;
}

using Key = std::pair<std::string, int>;  // a marker's ns and id
Key key_of(const Item& item) {
  return {item.who, item.says[1]};
}

/// The key of a posted marker. All markers without a namespace share one.
Key posted_key(const Item& item) {
  return {item.who.empty() ? "unnamed" : item.who, item.says[1]};
}

using Scene = std::map<Key, std::int64_t>;
void replay(Scene& scene, const Item& item) {
  switch (item.says[0]) {
    case kDeleteAll:
      return scene.clear();
    case kDelete:
      scene.erase(key_of(item));
      return;
    default:
      scene[key_of(item)] = item.serial;
  }
}

/// Messages that a serial server read after Adit had been led to another course.
class LateReads {
 public:
  void add(const Event& event) {
    if (event.kind == Kind::Leaves) left_[event.request] = event.at;
    if (event.kind == Kind::Saved && event.what == kCourse) switched_ = event.at;
  }
  bool is_late(const Event& taken) {
    return left_[taken.request] < switched_ && taken.at > switched_ + kSwitching;
  }

 private:
  static constexpr double kSwitching = 0.1;  // seconds; an answer may come until then
  std::map<std::uint64_t, double> left_;     // by connection
  double switched_ = -1;
};

/// The posting of an added marker with a lifetime, in seconds.
struct Fading {
  double began = 0, ended = 0, lifetime = 0;

  /// The fault of an item, or "". `leaves`, `left`: when the first and the last byte of its message left.
  /// `stood`: seconds for which the process stood still right before that.
  std::string check(const Item& item, double leaves, double left, double stood, bool same_process) const {
    const double most = lifetime - (leaves - ended) + kConnects + stood, sent = item.says[2] / 1000.0;
    const double least = lifetime - (left - began) - kLeastStep;
    if (item.says[0] == kDelete) return same_process && least > 0 ? "it was deleted too early" : "";
    if (most < 0) return "it was sent after its end";
    if (sent == 0 || sent > std::max(most, kLeastLifetime)) return "its lifetime was too long";
    return same_process && sent < least ? "its lifetime was too short" : "";
  }
};

/// A marker is sent with what remained of its lifetime, and deleted if nothing remained.
void check_lifetimes(const Evidence& evidence, const std::vector<Asked>& all, Broken& broken) {
  std::map<std::int64_t, Fading> posted;
  for (const Asked& asked : all) {
    if (!asked.may_count()) continue;
    for (const Item& item : asked.items) {
      if (item.says[2] == 0) continue;
      posted.try_emplace(item.serial, Fading{asked.began, asked.ended, item.says[2] / 1000.0});
    }
  }
  double process = 0;                      // when it began
  double stood = 0, stood_until = 0;       // the last time that it stood still
  std::map<std::uint64_t, double> leaves;  // by connection
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Begins) process = event.at;
    if (event.kind == Kind::Slow) stood = event.stamp, stood_until = event.at + event.stamp;
    if (event.what == kSendRejected) return;  // the operator's send begins the lifetime again
    if (event.what != kMarkers) continue;
    if (event.kind == Kind::Leaves) leaves[event.request] = event.at;
    const auto fading = event.kind == Kind::Left ? posted.find(event.serial) : posted.end();
    if (fading == posted.end()) continue;
    const Item item{.who = event.who, .serial = event.serial, .says = event.says};
    const std::string wrong = fading->second.check(
        item, leaves[event.request], event.at, stood_until > leaves[event.request] - kSoonAfter ? stood : 0,
        fading->second.began > process);
    if (wrong.empty()) continue;
    broken.push_back(
        icd::sentence("MarkersArrived: marker ", event.serial, " left at ", event.at, ": ", wrong));
  }
}

/// The value of each of `keys` after this request, if the request sets it.
std::map<Key, Item> says_of(const Asked& asked, const std::set<Key>& keys) {
  std::map<Key, Item> says;
  for (const Item& item : asked.items) {
    if (item.says[0] == kDeleteAll) {
      for (const Key& key : keys) says[key] = item;
    } else {
      says[posted_key(item)] = item;
    }
  }
  return says;
}

/// After the gateway has heard a status of another run, it sends no pose that it accepted and that was
/// posted before that run.
void check_runs(const Evidence& evidence, const std::vector<Asked>& states, Broken& broken) {
  std::map<std::int64_t, double> posted;  // the latest time at which each may have been posted
  for (const Asked& asked : states) {
    for (const Item& item : asked.items) posted[item.serial] = asked.ended;
  }
  double began = 0;
  bool is_heard = false;
  std::set<std::uint64_t> asks;  // requests for a status of this run
  std::map<std::uint64_t, std::set<std::int64_t>> under_way;
  std::set<std::int64_t> taken;  // in this process; the next one may not know them
  bool has_status = false;       // before its first status a process notices no other run
  for (const Event& event : evidence.events) {
    if (event.what == kCourse) return;
    if (event.kind == Kind::Begins) taken.clear(), has_status = false;
    if (event.kind == Kind::NewRun && event.what != kSameMap) {
      began = event.at;
      is_heard = false;
      asks.clear();
    }
    if (event.kind == Kind::Leaves && event.what == kStatus) asks.insert(event.request);
    if (event.kind == Kind::Leaves && event.what == kState) under_way[event.request].clear();
    const bool is_good = event.kind == Kind::Replied && event.status == 200 && event.who.empty();
    if (is_good && event.what == kStatus && !event.says.empty() && asks.erase(event.request) > 0)
      is_heard = has_status = true;
    if (event.what != kState) continue;
    if (is_good && has_status) taken.merge(under_way[event.request]);
    if (event.kind != Kind::Left) continue;
    under_way[event.request].insert(event.serial);
    if (is_heard && posted[event.serial] < began && taken.contains(event.serial))
      broken.push_back(icd::sentence("PoseArrived: ", event.who, " was sent with pose ", event.serial, " at ",
                                     event.at, ", in a run that began at ", began,
                                     ", after the pose was posted"));
  }
}

}  // namespace

void pose_arrived(const Evidence& evidence, Broken& broken) {
  std::map<std::string, Changes> changes;
  const std::vector<Asked> states = asked_in(evidence.events, kState);
  check_runs(evidence, states, broken);
  for (const Asked& asked : states) {
    if (!asked.may_count()) continue;
    for (const Item& item : asked.items) {
      Change change{asked.began, asked.ended, item.stamp, asked.accepted(), item.serial, item.says};
      if (item.says.size() > 1) {
        change.late = item.says[1] / 1000.0;
        change.sender.pop_back();
      }
      changes[item.who].push_back(std::move(change));
    }
  }
  std::map<std::string, std::int64_t> taken;
  // Another process or another course knows no accepted poses.
  std::vector<double> forgets;
  LateReads reads;
  for (const Event& event : evidence.events) {
    reads.add(event);
    const bool begins = event.kind == Kind::Begins || event.kind == Kind::Serves || event.what == kCourse;
    if (begins) forgets.push_back(event.at);
    if (event.kind == Kind::Taken && event.what == kState && !reads.is_late(event))
      taken[event.who] = event.serial;
  }
  for (const auto& [who, of_it] : changes) {
    const auto last = last_of(of_it, forgets);
    if (last.contains(taken[who])) continue;
    broken.push_back(
        icd::sentence("PoseArrived: ", who, " has at rest pose ", taken[who], ", not ", list_of(last)));
  }
}

void markers_arrived(const Evidence& evidence, Broken& broken) {
  const auto all = asked_in(evidence.events, kMarkers);
  check_lifetimes(evidence, all, broken);
  std::set<Key> keys;
  for (const Asked& asked : all) {
    for (const Item& item : asked.items) keys.insert(posted_key(item));
  }
  std::map<Key, Changes> changes;
  for (const Asked& asked : all) {
    if (!asked.may_count()) continue;
    // Not ordered by stamp: a marker's stamp is not its place in the scene's history.
    for (const auto& [key, item] : says_of(asked, keys)) {
      const std::int64_t serial = item.says[0] == kAdd ? item.serial : 0;
      changes[key].push_back(
          {asked.began, asked.ended, 0, asked.accepted(), serial, {}, item.says[2] > 0, &asked, item});
    }
  }
  Scene taken;
  LateReads reads;
  for (const Event& event : evidence.events) {
    reads.add(event);
    if (event.kind == Kind::Taken && event.what == kMarkers && !reads.is_late(event))
      replay(taken, {.who = event.who, .serial = event.serial, .says = event.says});
  }
  for (const Key& key : keys) {
    const auto last = last_of(changes[key]);
    const std::int64_t stands = taken.contains(key) ? taken[key] : 0;
    if (last.contains(stands)) continue;
    broken.push_back(icd::sentence("MarkersArrived: of marker ", key.second, " of ", key.first, " ", stands,
                                   " remains at rest, not ", list_of(last)));
  }
}

}  // namespace adit::simulation
