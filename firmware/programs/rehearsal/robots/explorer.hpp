#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "rehearsal/robots/client.hpp"
#include "rehearsal/robots/messages.hpp"
#include "rehearsal/robots/robot.hpp"

namespace adit::robots {

/// The markers of one robot: its shape, its way as a line and as nodes, dropped communication nodes, and
/// believed artifacts. Candidates are deleted when the operator has dealt with them, and path nodes when old.
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
  void remove(const std::string& ns, int id);
  void draw_way(const Vector3& position);

  std::string robot_;
  int path_nodes_ = 0, oldest_node_ = 0, comm_nodes_ = 0, candidates_ = 0, calls_ = 0;
  std::map<std::pair<std::string, int>, Marker> standing_;  // by ns and id
  std::vector<Marker> changes_;
  std::vector<Vector3> way_;
  std::map<int, double> candidates_until_;  // id: seconds
};

/// The amount of map data and the markers that each robot posted, rejected posts included. A rehearsal
/// Command Post compares them with its own. Any thread may write to it.
class PostedTotals {
 public:
  struct Amount {
    std::uint64_t amount = 0;  // cells or points posted so far, each counted once
    std::uint64_t places = 0;  // that have points (KnownPlaces); of grids 0
    Moment newest;             // the last map's date
  };
  void note(const std::string& robot, MessageKind kind, const Amount& amount);
  /// The robot's markers after its last post.
  void note(const std::string& robot, const std::vector<Marker>& standing);

  /// As POST /posted on the control port takes it.
  std::string json() const;

 private:
  mutable std::mutex mutex_;  // guards all below
  std::map<std::pair<std::string, MessageKind>, Amount> amounts_;
  std::map<std::string, std::vector<Marker>> standing_;  // by robot
};

/// Posts the amounts to the Command Post's control port. Returns its table of ages and shares, or why none.
std::string arrivals_of(const PostedTotals& posted, const Address& control);

/// A robot and the software on it: walks, and posts what it knows at the rates of the field. Poses 5 or 10
/// times a second, markers every 2 s, and the maps of its offer.
class Explorer {
 public:
  /// `cave`, `style`, `client`, `desk` and `posted` outlive the explorer.
  Explorer(const Cave& cave, std::uint64_t seed, std::size_t index, std::string name, const Style& style,
           const MapOffer& offer, Client& client, OperatorClient& desk, PostedTotals& posted);

  void work(double metres_per_second, const std::stop_token& finish);

 private:
  using Clock = std::chrono::steady_clock;

  double stamp(Clock::time_point now) const;
  MapTime map_time(Clock::time_point now) const;
  void post_grid(Clock::time_point now);
  void post_cloud(Clock::time_point now);
  void report_sightings(double seconds);

  const Cave& cave_;
  std::size_t index_;
  std::string name_;
  const Style& style_;
  Client& client_;
  OperatorClient& desk_;
  PostedTotals& posted_;
  Random random_;
  Robot robot_;
  MarkerScene scene_;
  MapMaker maps_;
  double clock_at_start_;  // what this robot's own clock says, which is nobody else's
  Clock::time_point start_;
};

}  // namespace adit::robots
