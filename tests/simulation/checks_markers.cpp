// PoseArrived and MarkersArrived: of what stands at rest, one value for each name.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "icd/sentence.hpp"
#include "simulation/asked.hpp"
#include "simulation/checks.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

constexpr double kOneClock = 1;  // second, by which stamps of one clock may be off
/// Seconds: a message that is late by less never shows that its clock was set back, by more always.
constexpr double kOutOfOrder = 1, kJump = 5;

/// What may have set a value, and when.
struct Change {
  double began, ended, stamp;
  bool accepted;
  std::int64_t serial;  // 0: it took the value away

  /// Whether `other` came after it for sure: by one clock's stamps, or else by when they were posted.
  bool is_before(const Change& other) const {
    const bool one_clock = std::abs((stamp - began) - (other.stamp - other.began)) < kOneClock;
    if (stamp != 0 && other.stamp != 0 && one_clock) return stamp < other.stamp;
    return ended < other.began;
  }
};
using Changes = std::vector<Change>;

/// Whether `late`, which was posted after `early`, may have been overtaken by it as far as its stamp tells:
/// the first late one of a clock that was set back may (`lanes/step_back.hpp`).
bool seems_overtaken(const Change& late, const Change& early, const Changes& all) {
  if (late.stamp == 0 || late.stamp >= early.stamp || late.stamp < early.stamp - kJump) return false;
  if (late.stamp >= early.stamp - kOutOfOrder) return true;
  return std::ranges::none_of(all, [&](const Change& first) {
    return first.accepted && early.ended < first.began && first.ended < late.began &&
           first.stamp < early.stamp - kOutOfOrder && first.stamp <= late.stamp;
  });
}

/// The values that may stand in the end: of each change that none that was accepted came after.
std::set<std::int64_t> last_of(const Changes& changes) {
  std::set<std::int64_t> last;
  bool any = false;
  for (const Change& change : changes) {
    bool over = false;
    for (const Change& other : changes)
      over = over || (other.accepted && change.is_before(other) && !seems_overtaken(other, change, changes));
    if (!over) last.insert(change.serial);
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

/// What each of `keys` is to be after this request, where it says anything of it.
std::map<Key, std::int64_t> says_of(const Asked& asked, const std::set<Key>& keys) {
  std::map<Key, std::int64_t> says;
  for (const Item& item : asked.items) {
    if (item.says[0] == kDeleteAll) {
      for (const Key& key : keys) says[key] = 0;
    } else {
      says[key_of(item)] = item.says[0] == kDelete ? 0 : item.serial;
    }
  }
  return says;
}

}  // namespace

void pose_arrived(const Evidence& evidence, Broken& broken) {
  std::map<std::string, Changes> changes;
  for (const Asked& asked : asked_in(evidence.events, kState)) {
    if (!asked.may_count()) continue;
    for (const Item& item : asked.items)
      changes[item.who].push_back({asked.began, asked.ended, item.stamp, asked.accepted(), item.serial});
  }
  std::map<std::string, std::int64_t> taken;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Taken && event.what == kState) taken[event.who] = event.serial;
  }
  for (const auto& [who, of_it] : changes) {
    const auto last = last_of(of_it);
    if (last.contains(taken[who])) continue;
    broken.push_back(icd::sentence("PoseArrived: ", who, " is at rest where ", taken[who],
                                   " said, and not where ", list_of(last), " did"));
  }
}

void markers_arrived(const Evidence& evidence, Broken& broken) {
  const auto all = asked_in(evidence.events, kMarkers);
  std::set<Key> keys;
  for (const Asked& asked : all) {
    for (const Item& item : asked.items) keys.insert(key_of(item));
  }
  std::map<Key, Changes> changes;
  for (const Asked& asked : all) {
    if (!asked.may_count()) continue;
    // In no order of stamps: a marker's is not its place in the scene's history.
    for (const auto& [key, serial] : says_of(asked, keys))
      changes[key].push_back({asked.began, asked.ended, 0, asked.accepted(), serial});
  }
  Scene taken;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Taken && event.what == kMarkers)
      replay(taken, {.who = event.who, .serial = event.serial, .says = event.says});
  }
  for (const Key& key : keys) {
    const auto last = last_of(changes[key]);
    const std::int64_t stands = taken.contains(key) ? taken[key] : 0;
    if (last.contains(stands)) continue;
    broken.push_back(icd::sentence("MarkersArrived: of marker ", key.second, " of ", key.first, " ", stands,
                                   " stands at rest, and not ", list_of(last)));
  }
}

}  // namespace adit::simulation
