// Obeyed: of the operator's word.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "icd/sentence.hpp"
#include "simulation/checks.hpp"
#include "simulation/courses.hpp"
#include "simulation/judge.hpp"
#include "simulation/messages.hpp"
#include "simulation/operator.hpp"

namespace adit::simulation {
namespace {

/// Seconds after which settings that were saved are those that count.
constexpr double kApplied = 5;

bool is_word(const Event& event, const char* what) {
  return event.what == what && event.who == kOperator;
}

/// What he held, withdrew or corrected stays with the box until he sends it, or another run is on.
void judge_held(const Evidence& evidence, Broken& broken) {
  std::map<std::int64_t, const Event*> kept;
  std::map<std::int64_t, int> reports;  // of a serial: in several runs there are several
  for (const dispatch::Report& report : evidence.reports) ++reports[serial_of(report)];
  for (const Event& event : evidence.events) {
    const bool is_done = event.kind == Kind::Answered && event.status == 200;
    if (is_done && (is_word(event, kHold) || is_word(event, kWithdraw))) kept[event.serial] = &event;
    if (is_done && is_word(event, kCorrect)) kept[event.serial - kCorrections] = &event;
    if (event.kind == Kind::Invoke && is_word(event, kSend)) kept.erase(event.serial);
    if (event.kind == Kind::NewRun) kept.clear();
    if (event.kind != Kind::Left || event.what != kReports || !kept.contains(event.serial) ||
        reports[event.serial] > 1)
      continue;
    broken.push_back(icd::sentence("Obeyed: report ", event.serial, " was sent at ", event.at,
                                   ", and the operator's last word was '", kept[event.serial]->what, "', at ",
                                   kept[event.serial]->at));
  }
}

/// With `review` as "all", what is posted goes at his word alone.
void judge_review(const Evidence& evidence, Broken& broken) {
  std::map<std::int64_t, double> posted;  // first
  std::set<std::int64_t> sent;
  double all_since = -1;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Invoke && event.what == kSettings) all_since = -1;
    if (event.kind == Kind::Saved && event.what != kCourse)
      all_since = event.what == kReviewAll ? event.at + kApplied : -1;
    if (event.kind == Kind::Invoke && (is_word(event, kSend) || is_word(event, kCorrect)))
      sent.insert(event.serial);
    if (event.kind == Kind::Invoke && (event.what == kReports || is_word(event, kCompose)))
      posted.emplace(event.serial, event.at);
    const bool goes = event.kind == Kind::Left && event.what == kReports;
    if (!goes || all_since < 0 || sent.contains(event.serial) || posted[event.serial] < all_since) continue;
    broken.push_back(icd::sentence("Obeyed: report ", event.serial, " was sent unseen at ", event.at,
                                   ", and every report is to be held"));
  }
}

/// What he composed while reports.undo_s was on goes no sooner, and after a restart meanwhile at his word
/// alone.
void judge_undo(const Evidence& evidence, Broken& broken) {
  struct Wait {
    double until;
    bool is_restarted = false;
  };
  std::map<std::int64_t, Wait> waits;
  double since = -1, undo = 0;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Invoke && event.what == kSettings) since = -1;
    if (event.kind == Kind::Saved && event.what != kCourse) {
      since = event.at + kApplied;
      undo = static_cast<double>(event.serial);
    }
    if (event.kind == Kind::Begins) {
      for (auto& [serial, wait] : waits) wait.is_restarted = wait.is_restarted || event.at < wait.until;
    }
    const bool is_told = event.kind == Kind::Invoke;
    if (is_told && (is_word(event, kCompose) || is_word(event, kCorrect)) && since >= 0 && event.at > since)
      waits.emplace(event.serial, Wait{.until = event.at + undo});
    if (is_told && is_word(event, kSend)) waits.erase(event.serial);
    const auto wait = waits.find(event.serial);
    if (event.kind != Kind::Left || event.what != kReports || wait == waits.end()) continue;
    if (event.at >= wait->second.until && !wait->second.is_restarted) continue;
    broken.push_back(icd::sentence("Obeyed: report ", event.serial, " was sent at ", event.at,
                                   ", and the operator could undo it until ", wait->second.until,
                                   wait->second.is_restarted ? ", when aditd had restarted" : ""));
  }
}

/// What he composed and was told of is kept.
void judge_composed(const Evidence& evidence, Broken& broken) {
  std::set<std::int64_t> kept;
  for (const dispatch::Report& report : evidence.reports) kept.insert(serial_of(report));
  for (const Event& event : evidence.events) {
    if (event.kind != Kind::Answered || event.status != 202 || !is_word(event, kCompose) ||
        kept.contains(event.serial))
      continue;
    broken.push_back(
        icd::sentence("Obeyed: the operator's report ", event.serial, " was answered 202, and is nowhere"));
  }
}

}  // namespace

void obeyed(const Evidence& evidence, Broken& broken) {
  judge_held(evidence, broken);
  judge_review(evidence, broken);
  judge_undo(evidence, broken);
  judge_composed(evidence, broken);
}

}  // namespace adit::simulation
