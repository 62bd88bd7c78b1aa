// Refused, Clean and StatusTrue: the ICD as seen from both sides.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "icd/sentence.hpp"
#include "simulation/bad_messages.hpp"
#include "simulation/checks.hpp"
#include "simulation/courses.hpp"
#include "simulation/messages.hpp"
#include "simulation/scoreboard.hpp"

namespace adit::simulation {
namespace {

constexpr double kOldest = 60;   // seconds since the status was requested, after which Adit does not serve it
constexpr double kOnItsWay = 1;  // seconds in which an answer reaches its client
constexpr double kConnecting = 3;  // seconds that a request may wait before its first byte leaves
constexpr int kTimeout = 408, kTooMany = 429, kStops = 503;

/// A status of the Command Post as Adit understood it, with the effect of the reports that were answered
/// since.
struct Known {
  double asked;
  double slow;          // seconds that the box had stood still for its disk until then
  std::set<Says> says;  // several: the answers may be of another run
};

/// `slow`: as in Known, at the time of the answer.
bool may_be(const Known& known, const Event& answer, double slow) {
  const double oldest = answer.at - known.asked;
  const double youngest = oldest - kOnItsWay - (slow - known.slow);
  return known.says.contains(answer.says) && youngest <= kOldest &&
         answer.stamp <= oldest + kConnecting + slow && answer.stamp >= std::floor(youngest);
}

/// After the answer to a report.
Known with_reply(Known known, const Says& reply, bool is_certain) {
  std::set<Says> says = is_certain ? std::set<Says>() : known.says;
  for (const Says& status : known.says)
    says.insert({status[0] + reply[2], status[1] - reply[1], std::max(status[2], reply[3])});
  known.says = std::move(says);
  return known;
}

/// A sign of another run, or another Command Post.
bool may_be_another_run(const Event& event) {
  return event.kind == Kind::NewRun || event.who == kSetBack || event.who == kRenames ||
         event.what == kCourse;
}

}  // namespace

void refused(const Evidence& evidence, Broken& broken) {
  std::map<std::uint64_t, const Event*> bad;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Invoke && event.status != 0) bad[event.request] = &event;
    const bool went = event.kind == Kind::Left || event.kind == Kind::Taken;
    if (went && event.serial >= kBadSerials && event.actor != Actor::Team)
      broken.push_back(icd::sentence("Refused: a bad message was sent to ", event.what, ", ", event.serial));
    if (event.kind != Kind::Answered || !bad.contains(event.request)) continue;
    const Event& asked = *bad[event.request];
    const bool elsewhere = event.status == kTimeout || event.status == kTooMany || event.status == kStops;
    if (event.status == asked.status || elsewhere) continue;
    broken.push_back(icd::sentence("Refused: ", asked.text, " (", asked.what, ", ", asked.serial,
                                   ") was answered ", event.status, ", not ", asked.status));
  }
}

void clean(const Evidence& evidence, Broken& broken) {
  for (const Event& event : evidence.events) {
    if (event.kind != Kind::Forbidden || event.what == kTooMuch) continue;
    if (event.what == kConnect || event.what == kListen) {
      const auto whose = event.what == kConnect ? "a socket to the Command Post" : "the team's socket";
      broken.push_back(icd::sentence("Apart: at ", event.at, " ", whose, " is ", event.text));
    } else {
      broken.push_back(icd::sentence("Clean: ", event.what, " at ", event.at, ": ", event.text));
    }
  }
}

void status_true(const Evidence& evidence, Broken& broken) {
  std::vector<Known> known;                         // in this process
  std::map<std::uint64_t, std::size_t> known_then;  // when a client asked
  std::map<std::uint64_t, std::int64_t> sent;       // the last report of each connection
  bool is_certain = true;                           // all answers are of the status's run
  double asked = 0, slow = 0;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Begins) known.clear(), known_then.clear();
    if (event.kind == Kind::Slow) slow += event.stamp;
    is_certain = is_certain && !may_be_another_run(event);
    if (event.what == kReports && event.kind == Kind::Left) sent[event.request] = event.serial;
    const bool is_recorded = event.what == kReports && event.kind == Kind::Replied &&
                             event.status / 100 == 2 && !event.says.empty() &&
                             event.says[0] == sent[event.request];
    if (is_recorded && !known.empty()) known.push_back(with_reply(known.back(), event.says, is_certain));
    if (event.what != kStatus) continue;
    if (event.kind == Kind::Leaves) asked = event.at;
    if (event.kind == Kind::Replied && event.status == 200 && !event.says.empty())
      known.push_back({asked, slow, {event.says}});
    if (event.kind == Kind::Invoke) known_then[event.request] = known.size();
    if (event.kind != Kind::Answered || event.status != 200) continue;
    // The answer is not older than the status that was known when the client asked.
    const std::size_t newest = known_then.contains(event.request) ? known_then[event.request] : 0;
    bool found = false;
    for (std::size_t i = newest == 0 ? 0 : newest - 1; i < known.size(); ++i)
      found = found || may_be(known[i], event, slow);
    if (found) continue;
    if (event.says.empty()) {
      broken.push_back(
          icd::sentence("StatusTrue: at ", event.at, " a client got a 200 that is not a status"));
      continue;
    }
    broken.push_back(icd::sentence("StatusTrue: at ", event.at, " a client got score ", event.says.at(0),
                                   ", ", event.says.at(1), " reports and clock ", event.says.at(2) / 1000.0,
                                   " of age ", event.stamp, ", which was not the last known status"));
  }
}

}  // namespace adit::simulation
