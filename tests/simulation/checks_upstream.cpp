// Paced, Learned and Stamps: of what goes to the Command Post.
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "icd/sentence.hpp"
#include "simulation/checks.hpp"
#include "simulation/counting.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr double kSpacing = 1;      // seconds between two requests of a URI: the settings' default
constexpr double kRounding = 1e-6;  // of the history's times
constexpr double kAhead = 5;        // seconds that a stamp may be after the clock for stamps
/// Seconds: a start of the machine begins where no stamp has been, so much ahead at the most; what was
/// written of that holds so long.
constexpr double kFloorAhead = 30, kFloorHolds = 35;
constexpr double kMakesWay = 1;       // seconds until the next gateway has begun
constexpr double kTriedAgain = 9;     // seconds
constexpr double kLongestPause = 30;  // that a Retry-After is heeded for
/// Bytes a second: less than maps get of the smallest budget that an operator sets.
constexpr std::int64_t kLeastGiven = 1'500'000;

}  // namespace

void paced(const Evidence& evidence, Broken& broken) {
  std::map<Kind, std::map<std::string, double>> last;  // of Leaves and of Complete
  struct Asked {
    double at, pause;
    int life;
  };
  std::map<std::string, Asked> asked;
  DiskFaultsSeen disk;
  double forgotten_until = 0;
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
    if (event.kind == Kind::Dies) asked.clear();  // the answer may have been read and not yet understood
    if (event.kind == Kind::Replied && event.status == 429)
      asked[event.what] = {event.at, std::min(event.stamp, kLongestPause), event.life};
    if (event.kind != Kind::Leaves && event.kind != Kind::Complete) continue;
    const auto before = last[event.kind].find(event.what);
    if (before != last[event.kind].end() && event.at - before->second < kSpacing - kRounding) {
      broken.push_back(icd::sentence(
          "Paced: ", event.what, " was asked ", event.at - before->second, " s after the last time, by its ",
          event.kind == Kind::Leaves ? "first byte" : "last byte", ", at ", event.at));
    }
    last[event.kind][event.what] = event.at;
    if (event.kind == Kind::Complete) continue;
    const auto pause = asked.find(event.what);
    if (pause != asked.end() && event.at - pause->second.at < pause->second.pause - kRounding) {
      broken.push_back(icd::sentence("Paced: ", event.what, " was asked ", event.at - pause->second.at,
                                     " s after a 429 that asked for ", pause->second.pause, " s, at ",
                                     event.at));
    }
    asked.erase(event.what);
  }
}

/// Whoever counts from its answers is found out by his first 429 that is heard, and tried again after 10 s at
/// the soonest (pace/rate_limit.hpp).
void learned(const Evidence& evidence, Broken& broken) {
  std::map<std::string, double> said, last;  // by URI: when it came too soon, unheard as yet, and heard
  DiskFaultsSeen disk;
  double forgotten_until = 0;
  for (const Event& event : evidence.events) {
    if (disk.forgets_at(event)) forgotten_until = event.at + kMakesWay + kSpacing;
    if (event.kind == Kind::Dies) last.clear();  // the answer may have been read and not yet understood
    disk.add(event);
    const auto unheard = said.find(event.what);
    if (event.kind == Kind::Replied && event.status == 429 && unheard != said.end()) {
      last[event.what] = unheard->second;
      said.erase(unheard);
    }
    if (event.kind != Kind::Fault || event.who != kTooSoon || event.at < forgotten_until) continue;
    const auto before = last.find(event.what);
    if (event.serial != static_cast<std::int64_t>(Counting::What::Answers)) {
      broken.push_back(icd::sentence("Learned: ", event.what,
                                     " came too soon for a Command Post that counts ",
                                     event.serial == 0 ? "first" : "last", " bytes, at ", event.at));
    } else if (before != last.end() && event.at - before->second < kTriedAgain) {
      broken.push_back(icd::sentence("Learned: ", event.what,
                                     " came too soon for a Command Post that counts ", "from its answers, ",
                                     event.at - before->second, " s after the last time, at ", event.at));
    }
    said[event.what] = event.at;
  }
}

void stamps(const Evidence& evidence, Broken& broken) {
  std::map<std::string, double> last;
  DiskFaultsSeen disk;
  double ahead = kAhead, forgotten_until = 0;
  double clock = 0;      // by which the box's is ahead of the world's
  bool by_clock = true;  // the next life may begin where that is: before the first stamp none need be kept
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::ClockSet) clock = event.stamp;
    by_clock = by_clock || event.kind == Kind::PowerCut || disk.forgets_at(event);
    if (event.kind == Kind::Begins && by_clock) ahead = std::max(ahead, kAhead + clock);
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
    if (event.stamp > World::kEpoch + event.at + ahead + kRounding) {
      broken.push_back(icd::sentence("Stamps: of ", event.what, " is ",
                                     event.stamp - World::kEpoch - event.at, " s ahead at ", event.at));
    }
  }
}

}  // namespace adit::simulation
