#include "simulation/intended_runs.hpp"

#include <algorithm>

#include "simulation/courses.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/messages.hpp"
#include "simulation/scoreboard.hpp"

namespace adit::simulation {
namespace {

/// Seconds. A report posted this long before a run began may be meant for that run, and a new run may be
/// unnoticed for as long.
constexpr double kShortly = 25;
/// Seconds from the answer until a timer makes the switch.
constexpr double kSwitching = 0.01;
/// Seconds in which a request may still count after its client heard no answer.
constexpr double kUnknown = 12;
constexpr const char* kUnwritten = "rejecting reports: the ledger cannot be ";

}  // namespace

int place_of(const std::string& run) {
  return run.starts_with("other") ? 1 : 0;
}

/// Both places, while the switch may be made or not.
std::set<int> IntendedRuns::places(double now) const {
  if (unsure_ || now < switched_ + kSwitching) return {before_, place_};
  return {place_};
}

void IntendedRuns::switched(const Event& event) {
  const int to = event.who == kOtherCourse ? 1 : 0;
  if (event.kind == Kind::Invoke) {
    if (!unsure_) before_ = place_;
    place_ = to;
    unsure_ = true;
  }
  if (event.kind == Kind::Answered) unsure_ = event.status != 200 && before_ != place_;
  switched_ = event.at;
}

void IntendedRuns::posted(const Event& event) {
  if (event.kind == Kind::Invoke) {
    postings_[event.serial].push_back({event.at, {}, false, event.request, event.what == kSend});
    open_[event.request] = {event.serial, 1e9};
  }
  const auto found = open_.find(event.request);
  if (found == open_.end()) return;
  if (event.kind == Kind::Answered) found->second.until = event.at;
  if (event.kind == Kind::Gone) found->second.until = event.at + kUnknown;
  reach(event.at);
}

void IntendedRuns::reach(double now) {
  const std::set<int> there = places(now);
  const bool unheard = !std::ranges::all_of(there, [this](int place) { return heard_.contains(place); });
  std::erase_if(open_, [now](const auto& each) { return each.second.until < now; });
  for (const auto& [request, open] : open_) {
    for (Posting& posting : postings_[open.serial]) {
      if (posting.request != request) continue;
      posting.places.insert(there.begin(), there.end());
      posting.unheard = posting.unheard || unheard;
    }
  }
}

void IntendedRuns::add(const Event& event) {
  if (event.kind == Kind::NewRun && event.what != kSameMap) run_began_[place_of(event.who)] = event.at;
  const bool is_status = event.kind == Kind::Replied && event.what == kStatus && !event.says.empty();
  if (is_status) heard_.insert(static_cast<int>(event.serial));
  const bool is_said = event.kind == Kind::Said;
  // Runs that were noticed while the ledger could not be written are forgotten.
  if (unwritten_ && event.kind == Kind::Begins) heard_ = heard_before_;
  if (event.kind == Kind::Begins) unwritten_ = false;
  if (is_said && event.text.contains(kUnwritten)) unwritten_ = true;
  if (event.kind == Kind::Begins) heard_before_ = heard_;
  if (event.actor != Actor::Team) return;
  if (event.what == kCourse) {
    switched(event);
    reach(event.at);
  }
  const bool is_word = event.what == kSend || event.what == kCompose || event.what == kCorrect;
  if (event.what == kReports || is_word) posted(event);
}

bool IntendedRuns::is_intended(std::int64_t serial, int place, double now) const {
  const auto began = run_began_.find(place);
  const double since = began == run_began_.end() ? -1e9 : began->second;
  const auto found = postings_.find(serial);
  if (found == postings_.end()) return false;
  const bool unnoticed = now < since + kShortly;
  return std::ranges::any_of(found->second, [&](const Posting& posting) {
    const bool there = posting.unheard || posting.places.contains(place);
    return there && (posting.at >= since - kShortly || unnoticed);
  });
}

bool IntendedRuns::is_sent_across(std::int64_t serial) const {
  const auto found = postings_.find(serial);
  return found != postings_.end() && std::ranges::any_of(found->second, [](const Posting& posting) {
           return posting.is_word && posting.places.size() > 1;
         });
}

bool IntendedRuns::is_sent_within(std::int64_t serial, double from, double until) const {
  const auto found = postings_.find(serial);
  return found != postings_.end() && std::ranges::any_of(found->second, [&](const Posting& posting) {
           return posting.is_word && posting.at > from && posting.at < until;
         });
}

}  // namespace adit::simulation
