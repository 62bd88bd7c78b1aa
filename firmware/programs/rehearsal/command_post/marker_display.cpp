#include "rehearsal/command_post/marker_display.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "rehearsal/command_post/fields.hpp"

namespace adit::rehearsal {
namespace {

constexpr int kDelete = 2, kDeleteAll = 3;
constexpr std::size_t kMostMarkers = 100'000, kMostRobots = 1000, kMostDifferences = 20;
constexpr double kSamePlace = 1e-3;  // metres: some robots post float32

}  // namespace

void MarkerDisplay::show(const std::vector<MarkerChange>& changes, Findings& findings) {
  if (changes.empty()) return;
  const std::lock_guard lock(mutex_);
  for (const MarkerChange& change : changes) {
    const Key key{change.ns, change.id};
    if (change.action == kDeleteAll) standing_.clear();
    if (change.action == kDelete) standing_.erase(key);
    if (change.action == 0 && (standing_.size() < kMostMarkers || standing_.contains(key)))
      standing_[key] = change.x;
  }
  for (std::size_t id = changes.size(); id < before_; ++id) {
    if (standing_.erase({"", static_cast<std::int64_t>(id)}) == 0) continue;
    findings.tells("markers: the organiser's display deletes id " + std::to_string(id) +
                   " of an empty ns because this message has fewer markers than the previous one");
  }
  before_ = changes.size();
}

std::expected<void, std::string> MarkerDisplay::told(const Json& posted) {
  Findings findings;
  const auto all = Field(posted, "", findings).elements();
  const std::lock_guard lock(mutex_);
  for (const Field& one : all.value_or(std::vector<Field>{})) {
    const auto standing = one.optional_member("standing");
    if (!standing) continue;
    const auto robot = one.member("robot");
    const auto name = robot ? robot->text() : std::nullopt;
    const auto markers = standing->elements();
    if (!name || !markers || (posted_.size() >= kMostRobots && !posted_.contains(*name))) break;
    Places places;
    for (const Field& marker : *markers) {
      const auto ns = marker.member("ns"), id = marker.member("id"), x = marker.member("x");
      const auto text = ns ? ns->text() : std::nullopt;
      const auto number = id ? id->integer(INT32_MIN, INT32_MAX) : std::nullopt;
      const auto at = x ? x->number() : std::nullopt;
      if (text && number && at && places.size() < kMostMarkers) places[{*text, *number}] = *at;
    }
    posted_[*name] = std::move(places);
  }
  if (findings.all().empty()) return {};
  return std::unexpected(findings.all().front().sentence);
}

/// Between what stands and what should.
std::vector<std::string> MarkerDisplay::differences() const {
  std::vector<std::string> all;
  std::set<std::string> told;  // namespaces of which some robot has told
  Places should;
  for (const auto& [robot, places] : posted_) {
    for (const auto& [key, x] : places) told.insert(key.first);
    should.insert(places.begin(), places.end());
  }
  const auto text = [](const Key& key) {
    return "marker " + std::to_string(key.second) + " of " + key.first;
  };
  for (const auto& [key, x] : should) {
    const auto found = standing_.find(key);
    if (found == standing_.end()) {
      all.push_back(text(key) + " is missing");
    } else if (std::abs(found->second - x) > kSamePlace) {
      all.push_back(text(key) + " is at x " + std::to_string(found->second) + ", not " + std::to_string(x));
    }
  }
  for (const auto& [key, x] : standing_) {
    if (told.contains(key.first) && !should.contains(key)) all.push_back(text(key) + " was deleted");
  }
  return all;
}

OrderedJson MarkerDisplay::json() const {
  const std::lock_guard lock(mutex_);
  std::size_t should = 0;
  for (const auto& [robot, places] : posted_) should += places.size();
  std::vector<std::string> first = differences();
  const std::size_t count = first.size();
  first.resize(std::min(count, kMostDifferences));
  return {
      {"here", standing_.size()}, {"posted", should}, {"difference_count", count}, {"differences", first}};
}

std::string MarkerDisplay::text() const {
  const OrderedJson all = json();
  if (all["posted"] == 0) return "";
  std::string lines = "markers: " + all["here"].dump() + " displayed, the robots have " +
                      all["posted"].dump() + "; " + all["difference_count"].dump() + " differ\n";
  for (const OrderedJson& sentence : all["differences"]) lines += "  " + sentence.dump() + "\n";
  return lines;
}

}  // namespace adit::rehearsal
