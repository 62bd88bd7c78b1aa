// Refused, Clean and StatusTrue: the ICD as seen from both sides.
#include <cmath>
#include <map>

#include "icd/sentence.hpp"
#include "simulation/asked.hpp"
#include "simulation/bad_messages.hpp"
#include "simulation/checks.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

constexpr double kOldest = 15;  // seconds since the status was requested, after which Adit does not serve it
constexpr double kOldestBehindReports = 60;  // the same, while a report is queued and after it
constexpr double kGoFirst = 15;    // seconds after a report in which reports may still have priority
constexpr double kOnItsWay = 1;    // seconds in which an answer reaches its client
constexpr double kConnecting = 3;  // seconds that a request may wait before its first byte leaves
constexpr int kTimeout = 408, kTooMany = 429, kStops = 503;

/// A status of the Command Post as Adit understood it.
struct Known {
  double asked;
  double slow;  // seconds that the box had stood still for its disk until then
  const Says* says;
};

/// `slow`: as in Known, at the time of the answer.
bool may_be(const Known& known, const Event& answer, double slow, double oldest_told) {
  const double oldest = answer.at - known.asked;
  const double youngest = oldest - kOnItsWay - (slow - known.slow);
  return *known.says == answer.says && youngest <= oldest_told &&
         answer.stamp <= oldest + kConnecting + slow && answer.stamp >= std::floor(youngest);
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
  OpenReports reports;
  double asked = 0, slow = 0, last_report = -1e9;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Begins) known.clear(), known_then.clear();
    reports.add(event);
    if (reports.any()) last_report = event.at;
    if (event.kind == Kind::Slow) slow += event.stamp;
    if (event.what != kStatus) continue;
    if (event.kind == Kind::Leaves) asked = event.at;
    if (event.kind == Kind::Replied && event.status == 200 && !event.says.empty())
      known.push_back({asked, slow, &event.says});
    if (event.kind == Kind::Invoke) known_then[event.request] = known.size();
    if (event.kind != Kind::Answered || event.status != 200) continue;
    // The answer is not older than the status that was known when the client asked.
    const std::size_t newest = known_then.contains(event.request) ? known_then[event.request] : 0;
    const bool is_behind = event.at - last_report <= kGoFirst + kOnItsWay + slow;
    const double oldest = is_behind ? kOldestBehindReports : kOldest;
    bool found = false;
    for (std::size_t i = newest == 0 ? 0 : newest - 1; i < known.size(); ++i)
      found = found || may_be(known[i], event, slow, oldest);
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
