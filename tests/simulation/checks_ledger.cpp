// OlderCopy, and what an older copy of the ledger may take.
#include <algorithm>
#include <map>
#include <set>

#include "icd/sentence.hpp"
#include "simulation/checks.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

/// Seconds until the number of the ledger's last record is in `stamps`: 10, a tick and the write. A process
/// begins with a write.
constexpr double kOnDisk = 12, kFirst = 3;
constexpr const char* kTellsDamage = "The ledger was damaged (";
constexpr const char* kFilesAreBack = "all files can be read again";

bool says(const Event& event, const char* words) {
  return event.kind == Kind::Said && event.text.contains(words);
}

bool is_left(const Event& event) {
  return event.kind == Kind::Left && event.what == kReports;
}

/// Times at which each report was posted first, and was sent first.
struct FirstTimes {
  explicit FirstTimes(const std::vector<Event>& events) {
    for (const Event& event : events) {
      const bool is_post = event.what == kReports || event.what == kCompose || event.what == kCorrect;
      if (event.kind == Kind::Invoke && is_post) posted.emplace(event.serial, event.at);
      if (is_left(event)) sent.emplace(event.serial, event.at);
    }
  }
  std::map<std::int64_t, double> posted, sent;  // by serial
};

/// Follows where the number of the last record is kept outside the ledger.
class KeptNumber {
 public:
  /// Steps up to this time are in that number.
  double in_memory(double ended) const { return has_memory_ ? ended : on_disk_; }
  double on_disk() const { return on_disk_; }
  /// Whether the disk has the number that memory has: a process has read it, and could write the disk.
  bool is_stored() const { return is_stored_; }

  void add(const Event& event) {
    if (is_up_ && !disk_.within(kOnDisk, event.at) && began_ + kFirst <= event.at)
      on_disk_ = std::max(on_disk_, event.at - kOnDisk);
    disk_.add(event);
    if (event.kind == Kind::Begins) began_ = event.at;
    // Otherwise it may not read the files, or not write them.
    if (event.kind == Kind::Begins) is_up_ = !disk_.within(0, event.at);
    if (event.kind == Kind::Stops || event.kind == Kind::Dies || event.kind == Kind::Ended) is_up_ = false;
    const bool is_ready = event.kind == Kind::Told && event.what == "READY";
    if (is_ready && is_up_) has_memory_ = true;
    if (event.kind == Kind::PutBack) is_stored_ = false;
    if (((is_ready && is_up_) || says(event, kFilesAreBack)) && !disk_.within(0, event.at)) is_stored_ = true;
    if (event.kind == Kind::PowerCut || (event.kind == Kind::Fault && event.who == "RuntimeFull"))
      has_memory_ = false;
  }

 private:
  DiskFaultsSeen disk_;
  bool is_up_ = false, has_memory_ = false, is_stored_ = false;
  double began_ = 0, on_disk_ = -1e9;
};

/// The next time that a copy was put back, or the end.
double next_after(const OlderCopies& copies, double at) {
  double next = 1e9;
  for (const OlderCopies::PutBack& each : copies.all()) {
    if (each.at > at) next = std::min(next, each.at);
  }
  return next;
}

/// If a report was posted after the copy, and sent early enough, its steps are known to be missing.
void check_told(const Evidence& evidence, const OlderCopies& copies, Broken& broken) {
  const FirstTimes times(evidence.events);
  for (const OlderCopies::PutBack& each : copies.all()) {
    const double next = next_after(copies, each.at);
    const bool is_told = std::ranges::any_of(evidence.events, [&](const Event& event) {
      return says(event, kTellsDamage) && event.at >= each.at && event.at < next;
    });
    if (is_told) continue;
    for (const auto& [serial, sent] : times.sent) {
      const auto posted = times.posted.find(serial);
      if (posted == times.posted.end() || posted->second <= each.copied || sent > each.known_until) continue;
      broken.push_back(icd::sentence("OlderCopy: the ledger lacks the steps of report ", serial, ", sent at ",
                                     sent, ", since its copy of ", each.copied, " was put back at ", each.at,
                                     ", but no damage is told"));
      break;
    }
  }
}

/// A ledger that lacks nothing is never called damaged. A process that cannot write, or ends early, leaves
/// the damage to the next one.
void check_accused(const Evidence& evidence, Broken& broken) {
  bool is_damaged = false, is_telling = false;
  DiskFaultsSeen disk;
  for (const Event& event : evidence.events) {
    disk.add(event);
    if (event.kind == Kind::PutBack && event.serial != 0) is_damaged = true;
    if (event.kind == Kind::Begins) is_telling = false;
    if (event.kind == Kind::Told && event.what == "READY" && is_telling && !disk.within(0, event.at))
      is_damaged = false;
    if (!says(event, kTellsDamage)) continue;
    is_telling = true;
    if (is_damaged) continue;
    broken.push_back(
        icd::sentence("OlderCopy: process ", event.process, " called a whole ledger damaged at ", event.at));
  }
}

/// A process that logs the damage shows an alarm.
void check_alarm(const Evidence& evidence, Broken& broken) {
  std::set<int> told;  // processes
  for (const Event& event : evidence.events) {
    if (says(event, kTellsDamage)) told.insert(event.process);
  }
  for (const Reading& reading : evidence.readings) {
    const bool is_its_answer = evidence.events[reading.heard - 1].process == reading.process;
    if (!told.contains(reading.process) || !is_its_answer) continue;
    const bool has_alarm = std::ranges::any_of(
        reading.view.at("alarms"), [](const auto& alarm) { return alarm.at("id") == "ledger_damaged"; });
    if (!has_alarm)
      broken.push_back(icd::sentence("OlderCopy: at ", reading.at, " no alarm tells the ledger's damage"));
  }
}

/// Each report that was lost with steps that are known to be missing has a number that is told as lost.
void check_lost(const Evidence& evidence, const OlderCopies& copies, Broken& broken) {
  std::set<std::int64_t> known;
  std::set<std::int64_t> lost;  // serials
  std::int64_t numbers = 0, last = 0;
  for (const dispatch::Report& report : evidence.reports) {
    known.insert(serial_of(report));
    if (report.is_lost()) numbers += report.number - last;
    last = report.number;
  }
  for (const std::int64_t serial : SentReports(evidence.events, copies).lost) {
    if (!known.contains(serial)) lost.insert(serial);
  }
  if (static_cast<std::int64_t>(lost.size()) > numbers)
    broken.push_back(icd::sentence("OlderCopy: ", lost.size(),
                                   " reports were sent and are not in the ledger, ", "the first is ",
                                   *lost.begin(), ", but ", numbers, " are told as lost"));
}

}  // namespace

OlderCopies::OlderCopies(const std::vector<Event>& events) {
  KeptNumber kept;
  double copied = 0, ended = 0;
  for (const Event& event : events) {
    if (event.kind == Kind::Copied) copied = event.at;
    if (event.kind == Kind::Dies || event.kind == Kind::Ended) ended = event.at;
    if (event.kind == Kind::PutBack && event.serial != 0)
      all_.push_back({.copied = copied,
                      .ended = ended,
                      .at = event.at,
                      .known_until = kept.in_memory(ended),
                      .on_disk = kept.on_disk()});
    const bool is_lost = event.kind == Kind::PowerCut && !kept.is_stored();
    // Or a kill has torn the file in memory.
    if (!all_.empty() && (is_lost || says(event, "an older copy of the ledger would not be found")))
      all_.back().known_until = std::min(all_.back().known_until, all_.back().on_disk);
    kept.add(event);
  }
}

const OlderCopies::PutBack* OlderCopies::taken_by(double step) const {
  const auto found =
      std::ranges::find_if(all_, [&](const PutBack& each) { return each.copied < step && step <= each.at; });
  return found == all_.end() ? nullptr : &*found;
}

SentReports::SentReports(const std::vector<Event>& events, const OlderCopies& copies) {
  for (const Event& event : events) {
    if (is_left(event)) kept.emplace(event.serial, event.at);
    if (event.kind != Kind::PutBack) continue;
    std::erase_if(kept, [&](const auto& each) {
      const OlderCopies::PutBack* const by = copies.taken_by(each.second);
      if (by != nullptr && each.second <= by->known_until) lost.insert(each.first);
      return by != nullptr;
    });
  }
}

bool OlderCopies::may_forget(double step, double now) const {
  return std::ranges::any_of(all_, [&](const PutBack& each) {
    return each.copied < step && each.known_until < step && step <= each.at && each.at <= now;
  });
}

bool is_anothers(const Event& event, const OlderCopies& copies) {
  return event.kind == Kind::Another ||
         (event.kind == Kind::Taken && event.what == kReports && copies.may_forget(event.at, 1e9));
}

void older_copy(const Evidence& evidence, Broken& broken) {
  const OlderCopies copies(evidence.events);
  check_told(evidence, copies, broken);
  check_accused(evidence, broken);
  check_alarm(evidence, broken);
  check_lost(evidence, copies, broken);
}

}  // namespace adit::simulation
