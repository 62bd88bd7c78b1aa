#include "simulation/asked.hpp"

#include <map>

#include "simulation/bad_messages.hpp"
#include "simulation/judge.hpp"

namespace adit::simulation {
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
    if (event.kind == Kind::Whole) asked.whole = true;
    if (event.kind == Kind::Answered) asked.status = event.status;
    asked.ended = event.kind == Kind::Answered ? event.at : event.at + kForgotten;
  }
  return all;
}

void OpenReports::add(const Event& event) {
  const bool is_posted = event.what == kReports || event.what == kCompose;
  if (event.actor == Actor::Team && is_posted && event.serial < kBadSerials) {
    if (event.kind == Kind::Invoke) posted_[event.request] = event.serial;
    const auto posted = posted_.find(event.request);
    const bool is_whole = event.kind == Kind::Whole && posted != posted_.end();
    if (is_whole && known_.insert(posted->second).second) open_.insert(posted->second);
  }
  const bool is_over = event.what == kDone || event.what == kWithdraw;
  if (is_over && event.kind == Kind::Answered && event.status / 100 == 2) open_.erase(event.serial);
  if (event.actor != Actor::Adit || event.what != kReports) return;
  if (event.kind == Kind::Left) sent_[event.request] = event.serial;
  const auto sent = sent_.find(event.request);
  if (event.kind != Kind::Replied || sent == sent_.end()) return;
  if (event.status / 100 == 2 && event.who.empty()) open_.erase(sent->second);
}

}  // namespace adit::simulation
