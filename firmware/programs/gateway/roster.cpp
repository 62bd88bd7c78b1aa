#include "gateway/roster.hpp"

#include <algorithm>

#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::gateway {

Roster::Roster(const std::vector<settings::Robot>& robots) {
  set_up(robots);
}

void Roster::set_up(const std::vector<settings::Robot>& robots) {
  names_.clear();
  for (const settings::Robot& robot : robots) names_.push_back(robot.name);
  std::erase_if(unknown_, [this](const auto& entry) {
    return names_.empty() || std::ranges::find(names_, entry.first) != names_.end();
  });
}

bool Roster::posted(const std::string& name, loop::Instant now) {
  if (names_.empty() || std::ranges::find(names_, name) != names_.end()) return false;
  if (!unknown_.contains(name) && unknown_.size() >= kMostUnknown) {
    std::erase_if(unknown_, [now](const auto& entry) { return now - entry.second >= kRecent; });
    if (unknown_.size() >= kMostUnknown) return false;
  }
  return unknown_.insert_or_assign(name, now).second;
}

std::vector<std::string> Roster::unknown(loop::Instant now) const {
  std::vector<std::string> names;
  for (const auto& [name, last] : unknown_) {
    if (now - last < kRecent) names.push_back(name);
  }
  return names;
}

std::string Roster::sentence(const std::string& name) const {
  return icd::sentence("unknown robot '", name, "' sends messages; the settings list ", icd::listed(names_));
}

}  // namespace adit::gateway
