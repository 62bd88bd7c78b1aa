#include "forward/delivered_scene.hpp"

#include <algorithm>

namespace adit::forward {

void DeliveredScene::forwarded(std::span<const icd::NamedPose> poses, api::Time now) {
  for (const icd::NamedPose& named : poses) {
    const std::string& name = named.name.text();
    if (robots_.size() >= kMostRobots && !robots_.contains(name)) forget_the_oldest();
    const double heading = api::heading_of(named.pose.orientation);
    robots_[name] = {.name = name, .position = named.pose.position, .heading = heading, .at = now};
    tracks_.forwarded(name, {.at = now, .position = named.pose.position, .heading = heading});
  }
}

void DeliveredScene::forget_the_oldest() {
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

void DeliveredScene::go_on_from(std::vector<api::Track> earlier) {
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
  tracks_.go_on_from(earlier);
}

std::vector<api::RobotRow> DeliveredScene::robots() const {
  std::vector<api::RobotRow> rows;
  rows.reserve(robots_.size());
  for (const auto& [name, row] : robots_) rows.push_back(row);
  return rows;
}

}  // namespace adit::forward
