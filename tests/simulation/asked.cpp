#include "simulation/asked.hpp"

#include <cmath>
#include <map>

#include "simulation/bad_messages.hpp"
#include "simulation/courses.hpp"
#include "simulation/deciding_operator.hpp"
#include "simulation/faults.hpp"
#include "simulation/messages.hpp"
#include "simulation/robot.hpp"
#include "simulation/upstream_view.hpp"

namespace adit::simulation {
namespace {

constexpr int kRequestTimeout = 408;
constexpr double kSameClock = 0.001, kHeadRead = 0.5;  // seconds
constexpr double kWritesDown = 0.05;                   // seconds until the ledger has recorded an answer
constexpr std::int64_t kUnknown = 0, kElsewhere = -1, kBefore = -2, kTwin = -3;  // serials
/// Faults after which the Command Post's answer is still correct.
const std::set<std::string> kRightAnswers = {name_of(Fault::Delay), name_of(Fault::OddAnswer),
                                             name_of(Fault::ClosesAfter)};

}  // namespace

std::vector<Asked> asked_in(const std::vector<Event>& events, const std::string& path) {
  std::vector<Asked> all;
  std::map<std::uint64_t, std::size_t> by_request;
  for (const Event& event : events) {
    if (event.actor != Actor::Team || event.what != path) continue;
    if (event.serial >= kBadSerials) continue;
    const auto [found, is_new] = by_request.try_emplace(event.request, all.size());
    if (is_new) all.push_back({.path = path, .items = {}, .began = event.at, .ended = event.at});
    Asked& asked = all[found->second];
    if (event.kind == Kind::Invoke) asked.items.push_back({event.who, event.serial, event.stamp, event.says});
    if (event.kind == Kind::Whole) {
      asked.whole = true;
      asked.whole_at = event.at;
    }
    if (event.kind == Kind::Answered) asked.status = event.status;
    asked.ended = event.kind == Kind::Answered ? event.at : event.at + kForgotten;
  }
  return all;
}

bool is_overtaken(const Asked& first, const Item& older, const Asked& second, const Item& newer) {
  const auto robot = [](const Item& item) { return item.serial / Robot::kSerials; };
  const double runs_on = (newer.stamp - second.began) - (older.stamp - first.began);
  return older.stamp != 0 && newer.stamp != 0 && robot(older) == robot(newer) &&
         std::abs(runs_on) < kSameClock && older.stamp < newer.stamp && second.whole &&
         first.began + kHeadRead < second.whole_at && second.whole_at < first.ended;
}

void OpenReports::add(const Event& event) {
  const bool is_posted = event.what == kReports || event.what == kCompose || event.what == kCorrect;
  if (event.actor == Actor::Team && is_posted && event.serial < kBadSerials) {
    if (event.kind == Kind::Invoke) posted_[event.request] = event.serial;
    const auto posted = posted_.find(event.request);
    const bool is_whole = event.kind == Kind::Whole && posted != posted_.end();
    if (is_whole && known_.insert(posted->second).second) {
      open_.insert(posted->second);
    } else if (is_whole && is_switched_ && open_.insert(posted->second).second) {
      repeated_.insert(posted->second);
    }
    const bool is_told = event.what == kReports && event.kind == Kind::Answered && event.status / 100 == 2;
    if (is_told && repeated_.erase(event.serial) > 0) open_.erase(event.serial);
  }
  // If one report is in doubt and an identical report is queued, a withdrawal withdraws the queued one.
  const bool is_over = event.what == kSettle || (event.what == kWithdraw && !in_doubt());
  const bool is_done = event.kind == Kind::Answered && event.status / 100 == 2;
  if (is_over && is_done) open_.erase(event.serial);
  if (event.what == kCorrect && is_done) open_.erase(event.serial - kCorrections);
  // The operator sends a report while the same report is in doubt. The answer decides one of them.
  if (event.kind == Kind::Invoke && event.what == kSend && doubts_.contains(event.serial))
    doubts_.insert(kTwin);
  if (event.kind == Kind::Dies) {
    for (const auto& [serial, at] : answered_) {
      if (event.at - at > kWritesDown) continue;
      open_.insert(serial);
      doubts_.insert(serial);
    }
  }
  // The process before may have recorded "sending" before the first byte left.
  if (event.kind == Kind::Begins && any()) doubts_.insert(is_switched_ ? kElsewhere : kBefore);
  if (event.what == kCourse && !doubts_.empty()) doubts_.insert(kElsewhere);
  is_switched_ = is_switched_ || event.what == kCourse;
  if (event.what != kReports) return;
  if (event.kind == Kind::Taken) recorded_.insert(event.serial);
  if (event.kind == Kind::Fault) is_odd_ = is_odd_ || !kRightAnswers.contains(event.who);
  if (event.actor != Actor::Adit) return;
  if (event.kind == Kind::Leaves) {
    doubts_.insert(kUnknown);
    is_odd_ = false;
  }
  if (event.kind == Kind::Left) {
    sent_[event.request] = event.serial;
    // The same report is sent again to another course, although the first course answered it.
    open_.insert(event.serial);
    repeated_.erase(event.serial);
    doubts_.insert(event.serial);
    doubts_.erase(kUnknown);
  }
  const auto sent = sent_.find(event.request);
  if (event.kind != Kind::Replied || sent == sent_.end()) return;
  const bool is_answered =
      event.status / 100 == 2 && event.who.empty() && !is_odd_ && recorded_.contains(sent->second);
  if (is_answered) {
    open_.erase(sent->second);
    answered_[sent->second] = event.at;
  }
  const bool is_rejected = event.status / 100 == 4 && event.status != kRequestTimeout;
  if (is_answered || is_rejected || event.who == kOtherForm) doubts_.erase(sent->second);
  if (open_.empty() && !doubts_.contains(kElsewhere) && !doubts_.contains(kTwin)) doubts_.clear();
}

}  // namespace adit::simulation
