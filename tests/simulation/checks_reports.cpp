// Once, Addressed, NotLost and Live, about reports.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "icd/sentence.hpp"
#include "simulation/checks.hpp"
#include "simulation/command_post.hpp"
#include "simulation/courses.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/faults.hpp"
#include "simulation/intended_runs.hpp"
#include "simulation/messages.hpp"
#include "simulation/scoreboard.hpp"
#include "simulation/team.hpp"
#include "simulation/upstream_view.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

using dispatch::ReportState;

std::map<std::int64_t, double> first_records(const Evidence& evidence) {
  std::map<std::int64_t, double> records;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Taken && event.what == kReports) records.emplace(event.serial, event.at);
  }
  return records;
}

/// One more report was granted, which hides one that was recorded.
bool is_grant(const Event& event) {
  return event.kind == Kind::NewRun && event.what == kSameMap;
}

/// Whether the evidence is ambiguous: another sender's record while this report was in doubt looks like
/// this report's, and a granted report makes it look unrecorded.
bool is_blurred(const Evidence& evidence, const dispatch::Report& report) {
  const Window window = window_of(evidence, report.sent - kLongestDoubt, report.changed);
  const OlderCopies copies(evidence.events);
  return std::ranges::any_of(evidence.events, [&](const Event& event) {
    return (is_anothers(event, copies) || is_grant(event)) && window.has(World::kEpoch + event.at);
  });
}

bool is_report(const Event& event, Kind kind) {
  return event.kind == kind && event.what == kReports;
}

}  // namespace

std::int64_t serial_of(const dispatch::Report& report) {
  return std::llround(report.report.position.x / 100);
}

/// Records whose answers Adit has read and kept.
class AnsweredRecords {
 public:
  using Record = std::pair<std::int64_t, std::string>;  // a report's serial, and its run

  /// Call for each event in order.
  void add(const Event& event) {
    disk_.add(event);
    if (is_report(event, Kind::Left)) in_flight_ = event.serial, is_spoiled_ = false;
    if (is_report(event, Kind::Taken)) last_[event.serial] = event.who;
    const bool spoils = event.who == name_of(Fault::WrongTypes) || event.who == kRepeats;
    if (is_report(event, Kind::Fault) && spoils) is_spoiled_ = true;
    const bool is_good = event.status / 100 == 2 && event.who.empty() && !is_spoiled_;
    const auto record = last_.find(in_flight_);
    if (is_report(event, Kind::Replied) && is_good && record != last_.end()) answered_[*record] = event.at;
    if (event.kind == Kind::Dies || event.kind == Kind::Ended) forget_unwritten(event.at);
  }
  bool has(const Record& record) const { return answered_.contains(record); }
  void forget(const OlderCopies& copies, double now) {
    std::erase_if(answered_, [&](const auto& each) { return copies.may_forget(each.second, now); });
  }

 private:
  /// An answer is on the disk within a second, or when the disk can be written again.
  void forget_unwritten(double now) {
    const double unwritten = disk_.within(kLongestDoubt, now) ? kLongestDoubt : 1;
    std::erase_if(answered_, [&](const auto& each) { return each.second > now - unwritten; });
  }

  DiskFaultsSeen disk_;
  std::int64_t in_flight_ = 0;
  bool is_spoiled_ = false;                   // its answer may be about another report
  std::map<std::int64_t, std::string> last_;  // the run of each report's last record
  std::map<Record, double> answered_;
};

/// Statuses that Adit has heard with more reports left than in the one before: a grant that it can see, and
/// remembers if it can write that down.
class RisesHeard {
 public:
  void add(const Event& event) {
    disk_.add(event);
    const bool ends = event.kind == Kind::Dies || event.kind == Kind::Ended;
    if (ends && disk_.within(event.at - last_, event.at)) last_ = -1e9;
    if (event.kind != Kind::Replied || event.what != kStatus || event.status != 200 || event.says.empty())
      return;
    const int left = event.says[1];
    const auto [before, is_first] = left_.try_emplace(event.serial, left);
    if (!is_first && left > before->second) last_ = event.at;
    before->second = left;
  }
  double last() const { return last_; }
  void forget(const OlderCopies& copies, double now) {
    if (copies.may_forget(last_, now)) last_ = -1e9;
  }

 private:
  DiskFaultsSeen disk_;
  std::map<std::int64_t, int> left_;  // by the Command Post's index
  double last_ = -1e9;
};

/// A run that shows what a new run would show: its clock was set back and it got another name, before Adit
/// could see that it gets another name in each answer.
class LooksLikeAnother {
 public:
  void add(const Event& event) {
    if (event.kind == Kind::NewRun) names_ = 0, is_set_back_ = false;
    if (event.kind != Kind::Fault) return;
    if (event.who == kSetBack && names_ <= 1) is_set_back_ = true;
    if (event.who == kRenames) ++names_;
    if (is_set_back_ && names_ == 1) last_ = event.at;
  }
  double last() const { return last_; }

 private:
  int names_ = 0;  // given to the run after the first
  bool is_set_back_ = false;
  double last_ = -1e9;
};

void once(const Evidence& evidence, Broken& broken) {
  struct Sent {
    double first = 0, last = 0;  // since the record before
  };
  struct Record {
    Sent sent;
    double at = 0;
  };
  std::map<std::pair<std::int64_t, std::string>, Record> records;  // the first of each
  std::map<std::int64_t, Sent> sent;                               // by serial
  IntendedRuns meant;
  AnsweredRecords answers;
  RisesHeard rises;
  LooksLikeAnother another;
  double granted = -kLongestDoubt;
  const OlderCopies copies(evidence.events);
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::PutBack) answers.forget(copies, event.at), rises.forget(copies, event.at);
    meant.add(event);
    another.add(event);
    if (is_grant(event)) granted = event.at;
    if (is_report(event, Kind::Left))
      sent.try_emplace(event.serial, Sent{.first = event.at}).first->second.last = event.at;
    if (!is_report(event, Kind::Taken)) {
      answers.add(event);
      rises.add(event);
      continue;
    }
    const bool costs = !event.who.ends_with(kInAStop);
    const auto its = sent.extract(event.serial);
    const Record record{.sent = its ? its.mapped() : Sent(), .at = event.at};
    const auto [place, is_first] = records.try_emplace({event.serial, event.who}, record);
    const Record& first = place->second;
    const bool again = !is_first;
    // A grant hides the record of a report in doubt, unless a status shows the grant. A course that was
    // switched away and back extends a doubt beyond a grant beside its first record.
    const bool is_hidden =
        event.at - granted <= kLongestDoubt || std::abs(first.at - granted) <= kLongestDoubt;
    const bool could_tell = !is_hidden || answers.has({event.serial, event.who}) || rises.last() > first.at;
    answers.add(event);
    const bool is_deceived = another.last() > first.at;
    // A serial server reads a report long after Adit has given it up. The operator may send it before.
    const bool is_late = meant.is_sent_within(event.serial, first.sent.first, first.at);
    const bool may_be_forgotten = copies.may_forget(first.sent.last, event.at);
    if (costs && again && could_tell && !is_deceived && !is_late && !may_be_forgotten &&
        !meant.is_sent_across(event.serial)) {
      broken.push_back(icd::sentence("Once: report ", event.serial, " was recorded again in ", event.who,
                                     " at ", event.at));
    }
    if (meant.is_intended(event.serial, place_of(event.who), event.at)) continue;
    broken.push_back(icd::sentence("Once: report ", event.serial, " was sent to ", event.who,
                                   ", for which it was not meant, at ", event.at));
  }
}

void not_lost(const Evidence& evidence, Broken& broken) {
  if (evidence.missing > 0)
    broken.push_back(icd::sentence("NotLost: ", evidence.missing, " records of the ledger are missing"));
  const auto records = first_records(evidence);
  std::set<std::int64_t> blurred;
  for (const dispatch::Report& report : evidence.reports) {
    if (is_blurred(evidence, report)) blurred.insert(serial_of(report));
  }
  for (const Event& event : evidence.events) {
    if (!is_report(event, Kind::Answered) || event.status >= 300) continue;
    // Clients of a corrected report are told of the correction.
    const bool is_recorded =
        std::ranges::any_of(std::array{event.serial, event.serial + kCorrections}, [&](std::int64_t serial) {
          const auto record = records.find(serial);
          return record != records.end() && record->second <= event.at;
        });
    if (!is_recorded && !blurred.contains(event.serial)) {
      broken.push_back(icd::sentence("NotLost: a client was answered that report ", event.serial,
                                     " is recorded, but it was not, at ", event.at));
    }
  }
  std::set<std::int64_t> known;
  for (const dispatch::Report& report : evidence.reports) known.insert(serial_of(report));
  for (const auto& [serial, at] : SentReports(evidence.events, OlderCopies(evidence.events)).kept) {
    if (!known.contains(serial))
      broken.push_back(
          icd::sentence("NotLost: report ", serial, " was sent at ", at, ", but is not in the ledger"));
  }
  for (const dispatch::Report& report : evidence.reports) {
    const bool claimed =
        report.state == ReportState::Answered || (report.state == ReportState::Settled && report.reconciled);
    if (claimed && !records.contains(serial_of(report)) && !is_blurred(evidence, report)) {
      broken.push_back(icd::sentence("NotLost: report ", serial_of(report), " is ",
                                     dispatch::name_of(report.state), ", but was not recorded"));
    }
  }
}

/// A fault after which the counts prove no report for longer, by README.md of dispatch.
bool ends_proof(const Event& event) {
  const bool is_fault = event.kind == Kind::Fault;
  return event.kind == Kind::Another || event.kind == Kind::PutBack || is_grant(event) ||
         (is_fault &&
          (event.who == name_of(Fault::AdminStop) || event.who == kSetBack || event.who == kRepeats));
}

/// Neither a run with a clock that stands, nor one without reports left.
bool can_be_counted(const Evidence& evidence) {
  std::set<int> clocks;
  for (const Event& event : evidence.events) {
    if (event.kind != Kind::Replied || event.what != kStatus || event.says.size() != 3) continue;
    if (event.says[1] == 0) return false;
    clocks.insert(event.says[2]);
  }
  return clocks.size() > 1;
}

/// Whether the course was switched before a process had time to decide about the lost answer. Adit asks for
/// the status of the Command Post that the settings name.
bool is_switched_early(const std::vector<Event>& events) {
  constexpr double kToDecide = 20;  // seconds
  bool is_lost = false;
  double began = 0;  // asking
  for (const Event& event : events) {
    const bool loses = event.kind == Kind::Fault && event.who == kLate;
    is_lost = is_lost || loses;
    if (loses || event.kind == Kind::Begins) began = event.at;
    const bool is_switch = event.kind == Kind::Saved && event.what == kCourse;
    if (is_lost && is_switch && event.at < began + kToDecide) return true;
  }
  return false;
}

void decided(const Evidence& evidence, Broken& broken) {
  const bool is_lost = std::ranges::any_of(
      evidence.events, [](const Event& event) { return event.kind == Kind::Fault && event.who == kLate; });
  if (!is_lost || !can_be_counted(evidence) || std::ranges::any_of(evidence.events, ends_proof)) return;
  if (is_switched_early(evidence.events)) return;
  for (const dispatch::Report& report : evidence.reports) {
    if (serial_of(report) != LateReporter::kSerial || report.state != ReportState::InDoubt) continue;
    broken.push_back(icd::sentence("Decided: report ", serial_of(report),
                                   " is in doubt, although the counts show it: ", report.note));
  }
}

void live(const Evidence& evidence, Broken& broken) {
  for (const dispatch::Report& report : evidence.reports) {
    if (report.state != ReportState::Queued && report.state != ReportState::Sending) continue;
    broken.push_back(
        icd::sentence("Live: report ", serial_of(report), " is still ", dispatch::name_of(report.state)));
  }
}

/// While the status is a web page, no report is sent that the operator has not sent since. A 404 is of
/// another form of the path.
void addressed(const Evidence& evidence, Broken& broken) {
  constexpr double kLongestAnswer = 12;  // seconds that a request to the course before may take
  std::optional<double> page;            // since when the status is a page
  double switched = -kLongestAnswer;
  std::set<std::int64_t> ordered;  // serials
  int form = 0;                    // of the path of the last report
  std::optional<int> redirected;   // to this form
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Begins || event.what == kCourse) page.reset();
    if (event.kind == Kind::Begins || event.what == kCourse) redirected.reset();
    if (event.what == kCourse) switched = event.at;
    if (event.what == kReports && event.kind == Kind::Leaves) {
      form = event.status;
      if (form != redirected.value_or(form))
        broken.push_back(icd::sentence("Addressed: a report was sent at ", event.at,
                                       " to the path that had redirected it"));
    }
    if (event.what == kReports && event.kind == Kind::Replied && event.at > switched + kLongestAnswer) {
      if (event.who == kOtherForm) redirected = kWithSlash - form;
      if (event.status == 404) redirected.reset();
    }
    if (event.kind == Kind::Invoke && event.what == kSend) ordered.insert(event.serial);
    if (event.what == kStatus && event.kind == Kind::Replied && event.status != 404) {
      const bool is_page = event.who == kForeign && event.status / 100 == 2;
      // The page may be the course's before, whose request was in flight.
      const bool may_be_earlier = event.at < switched + kLongestAnswer;
      page = is_page && !may_be_earlier ? std::optional(page.value_or(event.at)) : std::nullopt;
    }
    const bool leaves = event.what == kReports && event.kind == Kind::Left;
    if (!leaves || !page || ordered.contains(event.serial)) continue;
    broken.push_back(icd::sentence("Addressed: report ", event.serial, " was sent at ", event.at,
                                   ", although the status is a web page since ", *page));
  }
}

}  // namespace adit::simulation
