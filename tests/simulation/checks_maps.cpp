// CloudArrived.
#include <algorithm>
#include <map>
#include <ranges>
#include <set>
#include <span>
#include <utility>

#include "icd/sentence.hpp"
#include "simulation/asked.hpp"
#include "simulation/checks.hpp"
#include "simulation/courses.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/messages.hpp"
#include "simulation/scoreboard.hpp"
#include "simulation/upstream_view.hpp"

namespace adit::simulation {
namespace {

constexpr double kLongestSending = 60;  // seconds

/// A posted cloud and the events that delivered it.
struct Posted {
  const Asked* asked;
  const Item* item;
  std::vector<std::size_t> taken = {};
  std::set<int> points = {};  // that arrived in pieces since
  bool has_pieces = false;
  bool again = false;  // later clouds contained its points too
};
using Name = std::string;

/// The event delivered all points of the cloud, or the last ones of them.
void note_delivery(Posted& cloud, const Says& says, std::size_t event) {
  const int all = cloud.item->says.front();
  if (says[2] - says[1] + 1 != says[0]) return;  // points between them are missing
  cloud.has_pieces = cloud.has_pieces || says[0] < all;
  for (int index = says[1]; index <= says[2]; ++index) cloud.points.insert(index);
  if (std::cmp_less(cloud.points.size(), all)) return;
  cloud.points.clear();
  cloud.taken.push_back(event);
}

/// By name, the clouds that may have been accepted.
std::map<Name, std::vector<Posted>> posted_in(const Evidence& evidence, const std::vector<Asked>& all) {
  std::map<Name, std::vector<Posted>> posted;
  std::map<std::int64_t, std::pair<Name, std::size_t>> by_serial;
  for (const Asked& asked : all) {
    const Item& item = asked.items.front();
    if (is_grid(item.says) || !asked.may_count()) continue;
    auto& of_it = posted[item.who];
    by_serial[item.serial] = {item.who, of_it.size()};
    of_it.push_back({&asked, &item});
  }
  for (const Asked& asked : all) {
    for (const Item& item : asked.items | std::views::drop(1)) {
      const auto found = by_serial.find(item.serial);
      if (found != by_serial.end()) posted[found->second.first][found->second.second].again = true;
    }
  }
  for (std::size_t i = 0; i < evidence.events.size(); ++i) {
    const Event& event = evidence.events[i];
    if (event.what != kMap || event.kind != Kind::Taken || is_grid(event.says)) continue;
    const auto found = by_serial.find(event.serial);
    if (found == by_serial.end() || found->second.first != event.who) continue;
    note_delivery(posted[event.who][found->second.second], event.says, i);
  }
  return posted;
}

/// The event by which the message of this delivery had left.
std::size_t left_by(const std::vector<Event>& events, std::size_t taken) {
  std::size_t place = taken;
  const auto is_it = [&](const Event& event) {
    return event.kind == Kind::Left && event.what == kMap && event.request == events[taken].request &&
           event.serial == events[taken].serial;
  };
  while (place > 0 && !is_it(events[place])) --place;
  return place;
}

/// Whether a second delivery is allowed. One of these must hold: between the two the process was killed;
/// the first answer was lost or was not 200; the second left before the first and took long, after its
/// connection was lost; the operator sent a message again that was still rejected after a kill, although it
/// was queued by then or rejected twice.
bool may_be_double(const std::vector<Event>& events, std::size_t first, std::size_t second) {
  const auto is_kill = [](const Event& event) { return event.kind == Kind::Dies; };
  const auto is_word = [](const Event& event) {
    return event.kind == Kind::Invoke && event.what == kSendRejected;
  };
  const auto at = [&](std::size_t place) { return events.begin() + static_cast<std::ptrdiff_t>(place); };
  const auto kill = std::find_if(at(0), at(second), is_kill);
  if (std::any_of(kill, at(second), is_word)) return true;
  if (left_by(events, second) < left_by(events, first)) return true;
  int status = -1;
  for (std::size_t i = first; i < second; ++i) {
    const Event& event = events[i];
    if (event.kind == Kind::Dies) return true;
    if (event.what != kMap || event.request != events[first].request || status >= 0) continue;
    if (event.kind == Kind::Leaves) status = 0;
    if (event.kind == Kind::Replied && event.who.empty()) status = event.status;
  }
  return status != 200;
}

/// A run, a setting or a course began between the two, so the pieces before the last one must be sent now. A
/// clock that was set back, or a granted report, may look like another run, until the answer to a report
/// names the current run. So may a renamed run, until a status shows that it goes on.
bool may_go_whole(const std::vector<Event>& events, std::size_t first, std::size_t second) {
  bool is_set_back = false, is_renamed = false;
  for (std::size_t i = 0; i < second; ++i) {
    const Event& event = events[i];
    const bool sets_back = event.kind == Kind::Fault && event.who == kSetBack;
    is_set_back = is_set_back || sets_back || (event.kind == Kind::NewRun && event.what == kSameMap);
    is_renamed = is_renamed || (event.kind == Kind::Fault && event.who == kRenames);
    const bool is_answer = event.kind == Kind::Replied && event.what == kReports;
    const bool is_status = event.kind == Kind::Replied && event.what == kStatus;
    const bool names = ((is_set_back || is_renamed) && is_answer) || (is_renamed && is_status);
    const bool begins = event.kind == Kind::NewRun || event.kind == Kind::Saved || event.what == kCourse;
    if ((begins || sets_back || names) && event.at > events[first].at - kLongestSending) return true;
  }
  return false;
}

void check_clouds(const Evidence& evidence, const Name& name, const std::vector<Posted>& all,
                  Broken& broken) {
  for (const Posted& cloud : all) {
    if (cloud.asked->accepted() && cloud.taken.empty()) {
      broken.push_back(icd::sentence("CloudArrived: ", cloud.item->serial, " of '", name,
                                     "' was answered 200, but no cloud with all its points was delivered"));
    }
    for (std::size_t i = 1; i < cloud.taken.size() && !cloud.again; ++i) {
      if (may_be_double(evidence.events, cloud.taken[i - 1], cloud.taken[i])) continue;
      if (cloud.has_pieces && may_go_whole(evidence.events, cloud.taken[i - 1], cloud.taken[i])) continue;
      // A process does not know which pieces the one before has sent. Nor does a message that the operator
      // sends again, because one of its pieces was rejected.
      const auto begins_again = [](const Event& event) {
        return event.kind == Kind::Begins || event.what == kSendRejected;
      };
      const auto between =
          std::span(evidence.events).subspan(cloud.taken[i - 1], cloud.taken[i] - cloud.taken[i - 1]);
      if (cloud.has_pieces && std::ranges::any_of(between, begins_again)) continue;
      broken.push_back(icd::sentence("CloudArrived: ", cloud.item->serial, " of '", name,
                                     "' was delivered twice, at ", evidence.events[cloud.taken[i]].at));
    }
  }
}

}  // namespace

void cloud_arrived(const Evidence& evidence, Broken& broken) {
  for (const Event& event : evidence.events) {
    const bool taken = event.kind == Kind::Taken && event.what == kMap && !is_grid(event.says);
    if (taken && event.says.front() == kStrange)
      broken.push_back(icd::sentence(
          "CloudArrived: the Command Post accepted points that no client posted, of '", event.who, "'"));
  }
  const auto all = asked_in(evidence.events, kMap);
  for (const auto& [name, clouds] : posted_in(evidence, all)) check_clouds(evidence, name, clouds, broken);
}

}  // namespace adit::simulation
