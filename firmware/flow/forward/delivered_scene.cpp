#include "forward/delivered_scene.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

namespace adit::forward {
namespace {

constexpr double kEarly = 0.1;  // seconds: tolerance for poses once a second

std::vector<api::TrackPose> halve_poses(const std::vector<api::TrackPose>& poses) {
  std::vector<api::TrackPose> kept;
  kept.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); i += 2) kept.push_back(poses[i]);
  return kept;
}

}  // namespace

void Tracks::on_forwarded(const std::string& robot, const api::TrackPose& pose) {
  StoredTrack& track = tracks_[robot];
  if (!track.poses.empty()) {
    const api::TrackPose& last = track.poses.back();
    const double least = has_moved(last, pose) ? track.spacing : std::max(kStill, track.spacing);
    if (pose.at < last.at + least - kEarly) return;
  }
  if (track.poses.size() == kMostPoses) {
    track.poses = halve_poses(track.poses);
    track.spacing *= 2;
  }
  track.poses.push_back(pose);
}

void Tracks::restore(const std::vector<api::Track>& earlier) {
  const auto later = std::exchange(tracks_, {});
  for (const auto& [robot, poses] : earlier) {
    for (const api::TrackPose& pose : poses) on_forwarded(robot, pose);
  }
  for (const auto& [robot, kept] : later) {
    for (const api::TrackPose& pose : kept.poses) on_forwarded(robot, pose);
  }
}

void Tracks::move(double seconds) {
  for (auto& [robot, track] : tracks_) {
    for (api::TrackPose& pose : track.poses) pose.at += seconds;
  }
}

std::vector<api::Track> Tracks::tracks_after(api::Time since) const {
  std::vector<api::Track> tracks;
  for (const auto& [robot, kept] : tracks_) {
    const auto from = std::ranges::upper_bound(kept.poses, since, {}, &api::TrackPose::at);
    if (from != kept.poses.end()) tracks.push_back({robot, {from, kept.poses.end()}});
  }
  return tracks;
}

/// Versions rise over restarts, so that pages with older ones get all markers.
void MarkerScene::begin_change(api::Time now) {
  const auto by_clock = now > 0 ? static_cast<std::uint64_t>(now * 1000) : 0;
  version_ = std::max(version_ + 1, by_clock);
}

void MarkerScene::on_forwarded(std::span<const icd::Marker> markers, api::Time now) {
  for (const icd::Marker& marker : markers) {
    begin_change(now);
    apply(marker, now);
    keep_bounds();
  }
}

void MarkerScene::wipe(api::Time now) {
  begin_change(now);
  clear();
  left_out_ = 0;
}

void MarkerScene::clear() {
  entries_.clear();
  standing_ = gone_ = {};
  forgotten_ = version_;
}

void MarkerScene::apply(const icd::Marker& marker, api::Time now) {
  const Key key{marker.ns, marker.id};
  switch (marker.action) {
    case icd::MarkerAction::DeleteAll:
      clear();
      left_out_ = 0;
      return;
    case icd::MarkerAction::Delete:
      return remove(entries_.find(key));
    case icd::MarkerAction::Add: {
      Entry entry{.marker = api::draw_marker(marker), .at = now, .version = version_};
      const auto [at, is_new] = entries_.try_emplace(key);
      if (!is_new) release(at->second);
      return put(at, std::move(entry));
    }
  }
}

void MarkerScene::remove(Entries::iterator at) {
  if (at == entries_.end() || at->second.gone) return;
  release(at->second);
  put(at, {.marker = {.ns = at->first.first}, .version = version_, .gone = true});
}

void MarkerScene::put(Entries::iterator at, Entry entry) {
  EntryList& held = list_of(entry);
  held.bytes += entry.marker.size();
  held.in_order.emplace_hint(held.in_order.end(), entry.version, at);
  at->second = std::move(entry);
}

void MarkerScene::release(const Entry& entry) {
  EntryList& held = list_of(entry);
  held.bytes -= entry.marker.size();
  held.in_order.erase(entry.version);
}

void MarkerScene::keep_bounds() {
  const auto exceeds = [](const EntryList& held) {
    return held.in_order.size() > kMost || held.bytes > kMostBytes;
  };
  while (exceeds(standing_)) {
    ++version_;  // a separate change
    remove(standing_.in_order.begin()->second);
    ++left_out_;
  }
  while (exceeds(gone_)) {
    const auto [version, at] = *gone_.in_order.begin();
    forgotten_ = version;
    release(at->second);
    entries_.erase(at);
  }
}

api::MarkerChanges MarkerScene::changes(std::uint64_t since) const {
  const bool whole = since < forgotten_ || since > version_ || since == 0;
  api::MarkerChanges changes{
      .version = version_, .whole = whole, .left_out = left_out_, .markers = {}, .gone = {}};
  const auto news = [since, whole](const EntryList& held) {
    const auto& all = held.in_order;
    return std::ranges::subrange(whole ? all.begin() : all.upper_bound(since), all.end());
  };
  for (const auto& [version, at] : news(standing_))
    changes.markers.push_back({at->second.marker, at->second.at});
  if (whole) return changes;
  for (const auto& [version, at] : news(gone_)) changes.gone.push_back(at->first);
  return changes;
}

void DeliveredScene::on_forwarded(std::span<const icd::NamedPose> poses, api::Time now) {
  for (const icd::NamedPose& named : poses) {
    const std::string& name = named.name.text();
    if (robots_.size() >= kMostRobots && !robots_.contains(name)) forget_oldest();
    const double heading = api::heading_of(named.pose.orientation);
    robots_[name] = {.name = name, .position = named.pose.position, .heading = heading, .at = now};
    tracks_.on_forwarded(name, {.at = now, .position = named.pose.position, .heading = heading});
  }
}

void DeliveredScene::forget_oldest() {
  const auto oldest = std::ranges::min_element(robots_, {}, [](const auto& item) { return item.second.at; });
  tracks_.forget(oldest->first);
  robots_.erase(oldest);
}

void DeliveredScene::begin_run(api::Time now) {
  markers_.wipe(now);
  tracks_.wipe();
  before_.clear();
}

void DeliveredScene::move(double seconds) {
  for (auto& [name, robot] : robots_) {
    if (robot.at) *robot.at += seconds;
  }
  for (auto& [name, at] : before_) at += seconds;
  tracks_.move(seconds);
  markers_.move(seconds);
}

void DeliveredScene::restore(std::vector<api::Track> earlier) {
  for (const api::Track& track : earlier) {
    if (!track.poses.empty()) before_[track.robot] = track.poses.back().at;
  }
  std::erase_if(earlier, [this](const api::Track& track) {
    if (robots_.contains(track.robot)) return false;
    if (track.poses.empty() || robots_.size() >= kMostRobots) return true;
    const api::TrackPose& last = track.poses.back();
    robots_[track.robot] = {.name = track.robot, .position = last.position, .heading = last.heading};
    return false;
  });
  tracks_.restore(earlier);
}

std::vector<facts::RobotRow> DeliveredScene::robots() const {
  std::vector<facts::RobotRow> rows;
  rows.reserve(robots_.size());
  for (const auto& [name, row] : robots_) rows.push_back(row);
  return rows;
}

}  // namespace adit::forward
