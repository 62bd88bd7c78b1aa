#include "simulation/meant.hpp"

#include <algorithm>

#include "simulation/courses.hpp"
#include "simulation/judge.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

/// A report posted so shortly before a run began may be meant for it, and so long nobody may have noticed
/// that it began.
constexpr double kShortly = 25;
/// Seconds within which a switch that was asked for is made.
constexpr double kSwitching = 6;

}  // namespace

int place_of(const std::string& run) {
  return run.starts_with("other") ? 1 : 0;
}

/// Both, while it is not known which.
std::set<int> Meant::places(double now) const {
  if (unsure_ || now < switched_ + kSwitching) return {before_, place_};
  return {place_};
}

void Meant::switched(const Event& event) {
  const int to = event.who == kOtherCourse ? 1 : 0;
  if (event.kind == Kind::Invoke) {
    if (!unsure_) before_ = place_;
    place_ = to;
    unsure_ = true;
  }
  if (event.kind == Kind::Answered) unsure_ = event.status != 200 && before_ != place_;
  switched_ = event.at;
}

void Meant::posted(const Event& event) {
  if (event.kind == Kind::Invoke) {
    open_[event.request] = event.serial;
    const std::set<int> there = places(event.at);
    const bool unheard = !std::ranges::all_of(there, [this](int place) { return heard_.contains(place); });
    postings_[event.serial].push_back({event.at, there, unheard});
  } else if ((event.kind == Kind::Answered || event.kind == Kind::Gone) && open_.contains(event.request)) {
    postings_[event.serial].back().places.merge(places(event.at));
  }
}

void Meant::add(const Event& event) {
  if (event.kind == Kind::NewRun) run_began_[place_of(event.who)] = event.at;
  const bool is_status = event.kind == Kind::Replied && event.what == kStatus && !event.says.empty();
  if (is_status) heard_.insert(static_cast<int>(event.serial));
  if (event.actor != Actor::Team) return;
  if (event.what == kCourse) switched(event);
  if (event.what == kReports || event.what == kSend || event.what == kCompose) posted(event);
}

bool Meant::is_meant(std::int64_t serial, int place, double now) const {
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

}  // namespace adit::simulation
