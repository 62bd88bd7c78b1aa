#include "rehearsal/robots/scene.hpp"

namespace adit::robots {
namespace {

constexpr double kPathEvery = 2;     // metres
constexpr double kCommsEvery = 12;   // metres
constexpr int kPathNodes = 60;       // that stand at a time
constexpr double kCandidateFor = 8;  // seconds
constexpr std::size_t kWayPoints = 400;

}  // namespace

void MarkerScene::change(Marker marker) {
  const std::pair key{marker.ns, marker.id};
  if (marker.action == Marker::Delete) {
    standing_.erase(key);
  } else {
    standing_[key] = marker;
  }
  changes_.push_back(std::move(marker));
}

/// A trajectory, as the ICD names them (2.2), and where it ends the robot's own shape.
void MarkerScene::draw_way(const Vector3& position) {
  way_.push_back(position);
  if (way_.size() > kWayPoints) way_.erase(way_.begin());
  change({.ns = robot_ + "/way",
          .type = Marker::LineStrip,
          .position = {},
          .size = 0.05,
          .color = {.r = 0, .g = 1, .b = 0},
          .text = {},
          .points = way_});
  change({.ns = robot_ + "/shape",
          .type = Marker::Mesh,
          .position = position,
          .size = 1,
          .color = {.r = 0.8, .g = 0.8, .b = 0.8},
          .text = {},
          .mesh_resource = "package://rehearsal/meshes/robot.dae"});
}

void MarkerScene::pass(const Vector3& position, double walked, double seconds) {
  const std::string path = robot_ + "/path";
  if (walked >= path_nodes_ * kPathEvery) {
    draw_way(position);
    change({.ns = path,
            .id = path_nodes_++,
            .position = position,
            .size = 0.2,
            .color = {.r = 0, .g = 0.75, .b = 1},
            .text = {}});
  }
  if (path_nodes_ - oldest_node_ > kPathNodes) {
    Marker oldest = standing_.at({path, oldest_node_++});
    oldest.action = Marker::Delete;
    change(std::move(oldest));
  }
  if (walked >= comm_nodes_ * kCommsEvery) {
    change({.ns = robot_ + "/comms",
            .id = comm_nodes_++,
            .type = Marker::Cube,
            .position = position,
            .size = 0.4,
            .color = {.r = 1, .g = 0.5, .b = 0},
            .text = {}});
  }
  while (!candidates_until_.empty() && candidates_until_.begin()->second <= seconds) {
    Marker settled = standing_.at({robot_ + "/artifact", candidates_until_.begin()->first});
    settled.action = Marker::Delete;
    change(std::move(settled));
    candidates_until_.erase(candidates_until_.begin());
  }
}

void MarkerScene::candidate(const std::string& type, const Vector3& position, double seconds) {
  candidates_until_[candidates_] = seconds + kCandidateFor;
  change({.ns = robot_ + "/artifact",
          .id = candidates_++,
          .type = Marker::Text,
          .position = position,
          .size = 0.6,
          .color = {.r = 1, .g = 0.25, .b = 0.25},
          .lifetime = 600,
          .text = type + "?"});
}

std::vector<Marker> MarkerScene::standing() const {
  std::vector<Marker> all;
  all.reserve(standing_.size());
  for (const auto& [key, marker] : standing_) all.push_back(marker);
  return all;
}

std::vector<Marker> MarkerScene::take_changes() {
  if (++calls_ % 10 == 0) {
    for (const auto& [key, marker] : standing_) changes_.push_back(marker);
  }
  return std::exchange(changes_, {});
}

}  // namespace adit::robots
