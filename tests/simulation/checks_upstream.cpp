// Paced, Learned, OthersGoOn and Stamps, about requests to the Command Post.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "icd/sentence.hpp"
#include "simulation/asked.hpp"
#include "simulation/checks.hpp"
#include "simulation/command_post.hpp"
#include "simulation/counting.hpp"
#include "simulation/courses.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/messages.hpp"
#include "simulation/station.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr double kSpacing = 1;      // seconds between two requests of a URI: the settings' default
constexpr double kRounding = 1e-6;  // of the history's times
constexpr double kStampRounding = 1e-3;
constexpr double kAhead = 5;  // seconds that a stamp may be ahead of the clock for stamps
/// Seconds. After a boot, stamps begin beyond all earlier ones, at most kFloorAhead ahead. A stored floor
/// is valid for kFloorHolds.
constexpr double kFloorAhead = 170, kFloorHolds = 35;
constexpr double kMakesWay = 1;       // seconds until the next gateway has begun
constexpr double kTriedAgain = 9;     // seconds until Adit sends early again
constexpr double kLongestPause = 30;  // longest Retry-After that Adit obeys
constexpr double kVouches =
    13;                      // seconds that a status vouches for the run: 15, less the time to send a report
constexpr double kSoon = 1;  // seconds after a status in which a report that waited for it leaves
constexpr double kMostHeld = 4;  // seconds
constexpr double kGivesWay = 1;  // seconds in which a status gives way; Adit takes 0.2
/// Bytes per second: less than maps get of the smallest budget that an operator sets.
constexpr std::int64_t kLeastGiven = 1'500'000;

/// For messages with the station's clock, which runs like the world's: a robot's first message counts as
/// posted when it arrived, and each later one by the difference of the stamps. If a message was held so
/// long that the next one is far ahead of it, Adit learns the clock again (queues/stamps.hpp), and this
/// check leaves the robot out from then on.
class Spacing {
 public:
  explicit Spacing(const std::vector<Event>& events) {
    std::map<std::string, std::pair<double, double>>
        first;  // latest arrival of the first message, and how late it was
    std::set<std::string> is_held;
    for (const Asked& asked : asked_in(events, kState)) {
      for (const Item& item : asked.items) {
        if (item.stamp == 0 || item.says != Says{Station::kNumber}) continue;
        auto& [come, late] = first.try_emplace(item.who, 1e9, 1e9).first->second;
        if (asked.began < come) late = std::min(late, World::kEpoch + asked.began - item.stamp);
        if (asked.accepted()) come = std::min(come, asked.ended);
        if (asked.ended - asked.began > kMostHeld) is_held.insert(item.who);
        if (!is_held.contains(item.who)) least_[item.serial] = item.stamp + late;
      }
    }
  }
  /// The lower bound of its stamp upstream.
  double least(const Event& pose) const {
    const auto found = least_.find(pose.serial);
    return found == least_.end() ? 0 : found->second;
  }

 private:
  std::map<std::int64_t, double> least_;
};

}  // namespace

void paced(const Evidence& evidence, Broken& broken) {
  std::map<Kind, std::map<std::string, double>> last;  // of Leaves and of Complete
  struct Asked {
    double at, pause;
    int process;
    bool is_busy;  // by a 503
  };
  OpenReports reports;
  std::map<std::string, Asked> asked;
  DiskFaultsSeen disk;
  double forgotten_until = 0;
  std::set<std::uint64_t> under_way;  // connections of requests to this course
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Given && event.stamp == 0 && event.serial < kLeastGiven) {
      broken.push_back(icd::sentence("Paced: a line without a limit was given ", event.serial,
                                     " bytes a second, at ", event.at));
    }
    if (disk.forgets_at(event)) forgotten_until = event.at + kMakesWay;
    if (event.at < forgotten_until) {
      last.clear();
      asked.clear();
    }
    disk.add(event);
    if (event.kind == Kind::Begins || event.what == kCourse) {
      std::erase_if(asked, [](const auto& each) { return each.second.is_busy; });
      under_way.clear();
    }
    if (event.kind == Kind::Leaves) under_way.insert(event.request);
    if (event.kind == Kind::Dies) asked.clear();  // the answer may have been read and not yet processed
    reports.add(event);
    // A status may be needed by a report.
    const bool is_busy = event.status == 503 && event.stamp > 0 && event.what != kReports;
    const bool is_of_course = event.kind == Kind::Replied && under_way.erase(event.request) > 0;
    if (event.kind == Kind::Replied && (event.status == 429 || (is_busy && is_of_course)))
      asked[event.what] = {event.at, std::min(event.stamp, kLongestPause), event.process, is_busy};
    if (event.kind != Kind::Leaves && event.kind != Kind::Complete) continue;
    const auto before = last[event.kind].find(event.what);
    if (before != last[event.kind].end() && event.at - before->second < kSpacing - kRounding) {
      broken.push_back(icd::sentence("Paced: ", event.what, " was requested ", event.at - before->second,
                                     " s after the request before, by its ",
                                     event.kind == Kind::Leaves ? "first byte" : "last byte", ", at ",
                                     event.at));
    }
    last[event.kind][event.what] = event.at;
    if (event.kind == Kind::Complete) continue;
    const auto pause = asked.find(event.what);
    const bool is_needed =
        event.what == kStatus && pause != asked.end() && pause->second.is_busy && reports.any();
    if (pause != asked.end() && !is_needed && event.at - pause->second.at < pause->second.pause - kRounding) {
      broken.push_back(icd::sentence("Paced: ", event.what, " was requested ", event.at - pause->second.at,
                                     " s after an answer that asked for ", pause->second.pause, " s, at ",
                                     event.at));
    }
    asked.erase(event.what);
  }
}

/// A posted report does not wait for a status that is in flight. The check applies if nothing else can
/// delay the report: each earlier report was answered 2xx, the last one left long enough ago, a status
/// vouches for the run, the operator does nothing, the process does not stand still, no 429 in this process
/// has lowered the rate of reports, and the report leaves as soon as the status is over.
void reports_go_first(const Evidence& evidence, Broken& broken) {
  struct Status {
    std::uint64_t connection = 0;
    std::map<std::int64_t, double> waits;  // reports posted since it left, and when
  };
  std::optional<Status> status;
  std::map<std::int64_t, double> waited;         // how long each waited until a status was over
  double over = 0;                               // when that status was over
  std::map<std::uint64_t, std::int64_t> posted;  // by the client's request
  std::set<std::int64_t> known;                  // posted reports
  double left = 0;                               // when the last report left
  double heard = -kVouches;                      // when a status was read
  bool is_slowed = false;                        // by a 429 to a report, or for one limit over both
  OpenReports open;
  for (const Event& event : evidence.events) {
    const bool others_are_open = open.any();
    open.add(event);
    if (event.who == kOperator && status) status->waits.clear();
    if (event.kind == Kind::Begins || event.kind == Kind::Slow || event.what == kCourse) {
      status.reset();
      waited.clear();
      heard = -kVouches;
      if (event.kind != Kind::Slow) is_slowed = false;
    }
    const bool is_refused = event.kind == Kind::Replied && event.what == kReports && event.status == 429;
    is_slowed = is_slowed || is_refused || (event.kind == Kind::Fault && event.who == kBeyondOneLimit);
    // A status that was requested before the course was switched is not from this Command Post.
    if (event.kind == Kind::Replied && event.what == kStatus && !event.says.empty() && status &&
        status->connection == event.request)
      heard = event.at;
    if (event.actor == Actor::Team && event.what == kReports) {
      if (event.kind == Kind::Invoke) posted[event.request] = event.serial;
      const auto serial = posted.find(event.request);
      if (serial == posted.end()) continue;
      if (event.kind == Kind::Answered || event.kind == Kind::Gone) {
        if (status) status->waits.erase(serial->second);
      }
      if (event.kind != Kind::Whole || !known.insert(serial->second).second) continue;
      const bool may_go =
          !others_are_open && event.at - left > kSpacing && event.at - heard < kVouches && !is_slowed;
      if (status && may_go) status->waits.emplace(serial->second, event.at);
    }
    // Reports wait while the status is a web page.
    if (event.what == kStatus && event.kind == Kind::Replied && event.says.empty()) heard = -kVouches;
    if (event.what == kReports && event.kind == Kind::Leaves) left = event.at;
    const auto its = waited.find(event.serial);
    if (event.what == kReports && event.kind == Kind::Left && its != waited.end()) {
      if (its->second > kGivesWay && event.at - over < kSoon)
        broken.push_back(icd::sentence("Paced: report ", event.serial, " waited ", its->second,
                                       " s for a status, until ", over));
      waited.clear();
    }
    if (event.what == kStatus && event.kind == Kind::Leaves)
      status = {.connection = event.request, .waits = {}};
    const bool is_over = event.kind == Kind::Replied || event.kind == Kind::Closes;
    if (!is_over || !status || status->connection != event.request) continue;
    over = event.at;
    waited.clear();
    for (const auto& [serial, at] : status->waits) waited.emplace(serial, event.at - at);
    status.reset();
  }
}

/// A status keeps the same distance from a report as another report, unless it decides about a report in
/// doubt. A Command Post with one limit over both answers 429 for that once per process.
void status_keeps_away(const Evidence& evidence, Broken& broken) {
  std::optional<double> left;              // the last report of this process
  bool is_said = false, is_shown = false;  // it has answered that it has one limit; Adit has read that
  OpenReports open;
  for (const Event& event : evidence.events) {
    open.add(event);
    if (event.kind == Kind::Begins) left.reset();
    if (event.kind == Kind::Begins || event.what == kCourse) is_said = is_shown = false;
    if (event.kind == Kind::Replied && event.status == 429 && is_said) is_shown = true;
    if (event.kind == Kind::Fault && event.who == kBeyondOneLimit && !is_shown) is_said = true;
    if (event.what == kReports && event.kind == Kind::Leaves) left = event.at;
    if (open.in_doubt()) continue;
    if (event.what == kStatus && event.kind == Kind::Leaves && left &&
        event.at - *left < kSpacing - kRounding)
      broken.push_back(icd::sentence("Paced: the status was requested ", event.at - *left,
                                     " s after a report, at ", event.at));
    if (event.kind == Kind::Fault && event.who == kBeyondOneLimit && is_shown)
      broken.push_back(
          icd::sentence("Learned: ", event.what, " was sent too soon for one limit over all, at ", event.at));
  }
}

/// If a client asks for a newer status, one goes after at most three reports. Not checked if the last status
/// failed, because Adit then pauses, nor after a 429 in this process. A status may fail before it leaves:
/// then a connection ends.
void status_has_its_turn(const Evidence& evidence, Broken& broken) {
  constexpr int kInARow = 3;
  struct Process {
    double status = 0, report = 0;          // when the last ones left
    int in_a_row = 0;                       // reports since the last status
    bool is_well = false;                   // the last status was answered with a status
    std::optional<double> wanted;           // since when a client has an older status
    std::map<std::uint64_t, double> asked;  // clients' requests for the status
    std::set<std::uint64_t> mapping;        // connections
  };
  Process process;
  bool is_slowed = false;  // by a 429; Adit keeps what it has learned over a restart and for another course
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Begins || event.what == kCourse) process = {};
    const bool is_report = event.what == kReports, is_status = event.what == kStatus;
    if (event.kind == Kind::Replied && event.status == 429 && (is_report || is_status)) is_slowed = true;
    if (is_status && event.kind == Kind::Leaves)
      process.status = event.at, process.in_a_row = 0, process.is_well = false, process.wanted.reset();
    if (is_status && event.kind == Kind::Replied)
      process.is_well = event.status == 200 && !event.says.empty();
    const bool is_upstream = event.kind == Kind::Leaves && !is_report && !is_status;
    if (is_upstream) process.mapping.insert(event.request);
    if (event.kind == Kind::Closes && !process.mapping.contains(event.request)) process.is_well = false;
    if (is_status && event.kind == Kind::Invoke) process.asked[event.request] = event.at;
    const bool is_old = is_status && event.kind == Kind::Answered && event.status == 200 && event.stamp >= 1;
    if (is_old && process.asked[event.request] > process.status)
      process.wanted = process.wanted.value_or(event.at);
    if (!is_report || event.kind != Kind::Leaves) continue;
    const bool is_due = process.is_well && !is_slowed && process.wanted.value_or(1e9) < process.report;
    if (is_due && process.in_a_row >= kInARow)
      broken.push_back(
          icd::sentence("Paced: ", process.in_a_row + 1,
                        " reports in a row were sent, although a client has asked for the status "
                        "since ",
                        *process.wanted, ", at ", event.at));
    ++process.in_a_row;
    process.report = event.at;
  }
}

/// A Command Post that counts from its answers is detected by its first 429 that Adit reads. Adit tries
/// again after 10 s at the earliest, and once until a kill or a power cut (pace/rate_limit.hpp).
void learned(const Evidence& evidence, Broken& broken) {
  std::map<std::string, double> said, last;  // by URI: a 429 for "too soon", not yet read, and read
  std::set<std::string> single;              // URIs whose last answer was such a 429
  std::map<std::string, int> times;          // by URI: such 429s followed by a 2xx
  DiskFaultsSeen disk;
  double forgotten_until = 0;
  for (const Event& event : evidence.events) {
    if (disk.forgets_at(event)) forgotten_until = event.at + kMakesWay + kSpacing;
    const bool forgets = disk.forgets_at(event) || event.kind == Kind::Dies || event.kind == Kind::PowerCut;
    // At a death the answer may have been read and not yet processed.
    if (forgets) times.clear(), single.clear(), last.clear();
    // Adit cannot know from a page of HTML, or from a body that is too long, whether the message was
    // accepted.
    const bool is_accepted = event.kind == Kind::Replied && event.status / 100 == 2 && event.who.empty();
    if (is_accepted && single.erase(event.what) > 0) ++times[event.what];
    if (event.kind == Kind::Replied && event.status == 429) single.erase(event.what);
    disk.add(event);
    const auto unheard = said.find(event.what);
    if (event.kind == Kind::Replied && event.status == 429 && unheard != said.end()) {
      single.insert(event.what);
      last[event.what] = unheard->second;
      said.erase(unheard);
    }
    // The answer may be in flight for long.
    if (event.kind != Kind::Fault || event.who != kTooSoon || event.stamp < forgotten_until) continue;
    const auto before = last.find(event.what);
    if (event.serial != static_cast<std::int64_t>(Counting::What::Answers)) {
      broken.push_back(icd::sentence("Learned: ", event.what,
                                     " was sent too soon for a Command Post that counts ",
                                     event.serial == 0 ? "first" : "last", " bytes, at ", event.at));
    } else if (before != last.end() && event.at - before->second < kTriedAgain) {
      broken.push_back(icd::sentence(
          "Learned: ", event.what, " was sent too soon for a Command Post that counts ", "from its answers, ",
          event.at - before->second, " s after the request before, at ", event.at));
    } else if (times[event.what] > 1) {
      broken.push_back(
          icd::sentence("Learned: ", event.what,
                        " was sent too soon for the third time for a Command Post that counts from "
                        "its answers, at ",
                        event.at));
    }
    said[event.what] = event.at;
  }
}

/// While one robot's states are rejected, those of the others arrive: after three states with several robots
/// and one with the rejected robot alone, the next one has another robot with news. A flood's poses do not
/// count, because it posts them at once, so that the last one need not have the highest serial.
void others_go_on(const Evidence& evidence, Broken& broken) {
  constexpr int kInARow = 4;
  std::map<std::uint64_t, std::vector<std::pair<std::string, std::int64_t>>>
      posted;                                           // by the client's request
  std::map<std::string, std::int64_t> accepted, taken;  // the last serial of each robot; serials rise
  std::set<std::string> news;                           // robots with news when the first state was rejected
  int in_a_row = 0;                                     // rejected states
  bool is_rejected = false, is_read = false;            // the last state, and Adit has read the answer
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::PowerCut) accepted.clear();
    if (event.kind == Kind::Begins || event.what == kCourse) in_a_row = 0, is_rejected = is_read = false;
    if (event.what != kState) continue;
    if (event.kind == Kind::Invoke) posted[event.request].emplace_back(event.who, event.serial);
    if (event.kind == Kind::Answered && event.status == 200) {
      for (const auto& [who, serial] : posted[event.request]) accepted[who] = std::max(accepted[who], serial);
    }
    if (event.kind == Kind::Taken) taken[event.who] = std::max(taken[event.who], event.serial);
    if (event.kind == Kind::Leaves) {
      if (!is_rejected || !is_read) in_a_row = 0;
      is_rejected = is_read = false;
    }
    if (event.kind == Kind::Replied) is_read = true;
    if (event.kind != Kind::Fault || event.who != kUnregistered) continue;
    if (std::exchange(is_rejected, true)) continue;  // of the process before, and read late
    if (++in_a_row == 1) {
      news.clear();
      for (const auto& [who, serial] : accepted) {
        if (who != event.text && who != "flood" && serial > taken[who]) news.insert(who);
      }
    }
    if (in_a_row == kInARow + 1 && !news.empty())
      broken.push_back(icd::sentence("OthersGoOn: ", in_a_row, " states in a row were rejected because of ",
                                     event.text, ", although ", *news.begin(), " has news, at ", event.at));
  }
}

void stamps(const Evidence& evidence, Broken& broken) {
  std::map<std::string, double> last;
  const Spacing spacing(evidence.events);
  bool is_spaced = true;  // no clock of a robot was forgotten
  DiskFaultsSeen disk;
  double ahead = kAhead, forgotten_until = 0;
  double clock = 0;      // how far the box's clock is ahead of the world's
  bool by_clock = true;  // the next process may begin at the box's clock, because no stamp need be stored
                         // before the first
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::ClockSet) clock = event.stamp;
    by_clock = by_clock || event.kind == Kind::PowerCut || disk.forgets_at(event);
    const bool begins_by_clock = event.kind == Kind::Begins && by_clock && clock != 0;
    if (begins_by_clock) ahead = std::max(ahead, kAhead + clock);
    is_spaced = is_spaced && event.kind != Kind::PowerCut && !disk.forgets_at(event) && !begins_by_clock;
    if (disk.forgets_at(event)) {
      ahead += kFloorAhead;
      forgotten_until = event.at + kMakesWay;
    }
    if (event.at < forgotten_until) last.clear();
    disk.add(event);
    if (event.kind == Kind::PowerCut) {
      ahead += kFloorAhead;
      if (disk.within(kFloorHolds, event.at)) last.clear();
    }
    if (event.kind != Kind::Left || event.stamp == 0) continue;
    by_clock = false;
    double& before = last[event.what];
    if (event.stamp < before) {
      broken.push_back(icd::sentence("Stamps: of ", event.what, " ran back by ", before - event.stamp,
                                     " s at ", event.at));
    }
    before = std::max(before, event.stamp);
    const double least = event.what == kState ? spacing.least(event) : 0;
    if (is_spaced && event.stamp < least - kStampRounding) {
      broken.push_back(icd::sentence("Stamps: of ", event.who, " ", event.serial, " is ", least - event.stamp,
                                     " s nearer to those before than it was stamped, at ", event.at));
    }
    if (event.stamp > World::kEpoch + event.at + ahead + kRounding) {
      broken.push_back(icd::sentence("Stamps: of ", event.what, " is ",
                                     event.stamp - World::kEpoch - event.at, " s ahead at ", event.at));
    }
  }
}

}  // namespace adit::simulation
