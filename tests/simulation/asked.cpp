#include "simulation/asked.hpp"

#include <map>

#include "simulation/bad_messages.hpp"

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

}  // namespace adit::simulation
