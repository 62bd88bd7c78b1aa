// Obeyed: Adit follows the operator's decisions.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "icd/sentence.hpp"
#include "simulation/checks.hpp"
#include "simulation/courses.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/messages.hpp"
#include "simulation/operator.hpp"

namespace adit::simulation {
namespace {

/// Seconds until saved settings apply.
constexpr double kApplied = 5;

bool is_word(const Event& event, const char* what) {
  return event.what == what && event.who == kOperator;
}

/// A report that the operator held, withdrew or corrected is not sent until he sends it or another run
/// begins.
void check_held(const Evidence& evidence, Broken& broken) {
  std::map<std::int64_t, const Event*> kept;
  const OlderCopies copies(evidence.events);
  std::map<std::int64_t, int> reports;  // per serial: several runs can have one each
  for (const dispatch::Report& report : evidence.reports) ++reports[serial_of(report)];
  for (const Event& event : evidence.events) {
    const bool is_done = event.kind == Kind::Answered && event.status == 200;
    if (is_done && (is_word(event, kHold) || is_word(event, kWithdraw))) kept[event.serial] = &event;
    if (is_done && is_word(event, kCorrect)) kept[event.serial - kCorrections] = &event;
    if (event.kind == Kind::Invoke && is_word(event, kSend)) kept.erase(event.serial);
    if (event.kind == Kind::NewRun) kept.clear();
    if (event.kind == Kind::PutBack)
      std::erase_if(kept, [&](const auto& each) { return copies.may_forget(each.second->at, event.at); });
    if (event.kind != Kind::Left || event.what != kReports || !kept.contains(event.serial) ||
        reports[event.serial] > 1)
      continue;
    broken.push_back(icd::sentence("Obeyed: report ", event.serial, " was sent at ", event.at,
                                   ", but the operator's last decision was '", kept[event.serial]->what,
                                   "', at ", kept[event.serial]->at));
  }
}

/// While `review` is "all", a posted report is sent only after the operator's word.
void check_review(const Evidence& evidence, Broken& broken) {
  std::map<std::int64_t, double> posted;  // the first time
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
    broken.push_back(icd::sentence("Obeyed: report ", event.serial,
                                   " was sent without the operator's word at ", event.at,
                                   ", although every report is to be held"));
  }
}

/// A report that the operator composed while reports.undo_s was on is not sent sooner. After a restart
/// within that time it is sent only after his word.
void check_undo(const Evidence& evidence, Broken& broken) {
  struct Wait {
    double until;
    bool is_answered = false, is_restarted = false;
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
      // The next process may read a request that was not answered.
      for (auto& [serial, wait] : waits)
        wait.is_restarted = wait.is_restarted || (wait.is_answered && event.at < wait.until);
    }
    const bool is_told = event.kind == Kind::Invoke;
    if (is_told && (is_word(event, kCompose) || is_word(event, kCorrect)) && since >= 0 && event.at > since)
      waits.emplace(event.serial, Wait{.until = event.at + undo});
    if (is_told && is_word(event, kSend)) waits.erase(event.serial);
    const auto asked = waits.find(event.serial);
    if (event.kind == Kind::Answered && (event.what == kCompose || event.what == kCorrect) &&
        asked != waits.end())
      asked->second.is_answered = true;
    const auto wait = waits.find(event.serial);
    if (event.kind != Kind::Left || event.what != kReports || wait == waits.end()) continue;
    if (event.at >= wait->second.until && !wait->second.is_restarted) continue;
    broken.push_back(icd::sentence("Obeyed: report ", event.serial, " was sent at ", event.at,
                                   ", although the operator could undo it until ", wait->second.until,
                                   wait->second.is_restarted ? ", after a restart of aditd" : ""));
  }
}

/// A composed report that was answered is in the ledger.
void check_composed(const Evidence& evidence, Broken& broken) {
  std::set<std::int64_t> kept;
  const OlderCopies copies(evidence.events);
  for (const dispatch::Report& report : evidence.reports) kept.insert(serial_of(report));
  for (const Event& event : evidence.events) {
    if (event.kind != Kind::Answered || event.status != 202 || !is_word(event, kCompose) ||
        kept.contains(event.serial) || copies.taken_by(event.at) != nullptr)
      continue;
    broken.push_back(icd::sentence("Obeyed: the operator's report ", event.serial,
                                   " was answered 202, but is not in the ledger"));
  }
}

}  // namespace

void obeyed(const Evidence& evidence, Broken& broken) {
  check_held(evidence, broken);
  check_review(evidence, broken);
  check_undo(evidence, broken);
  check_composed(evidence, broken);
}

}  // namespace adit::simulation
