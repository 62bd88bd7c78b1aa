#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// The markers of one robot: its shape, the way it has gone as a line and as nodes, the communication nodes
/// that it drops, the artifacts that it believes to see. Candidates are deleted when the operator has dealt
/// with them, and path nodes when they are old.
class MarkerScene {
 public:
  explicit MarkerScene(std::string robot) : robot_(std::move(robot)) {}

  /// The robot is at `position` after `walked` metres, `seconds` after the start of its run.
  void pass(const Vector3& position, double walked, double seconds);
  void candidate(const std::string& type, const Vector3& position, double seconds);

  /// What changed since the last call; now and then (every tenth call) all that stands.
  std::vector<Marker> take_changes();
  std::vector<Marker> standing() const;

 private:
  void change(Marker marker);
  void draw_way(const Vector3& position);

  std::string robot_;
  int path_nodes_ = 0, oldest_node_ = 0, comm_nodes_ = 0, candidates_ = 0, calls_ = 0;
  std::map<std::pair<std::string, int>, Marker> standing_;  // by ns and id
  std::vector<Marker> changes_;
  std::vector<Vector3> way_;
  std::map<int, double> candidates_until_;  // id: seconds
};

}  // namespace adit::robots
