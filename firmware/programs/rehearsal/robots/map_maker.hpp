#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "rehearsal/known_cells.hpp"
#include "rehearsal/known_places.hpp"
#include "rehearsal/robots/dated.hpp"
#include "rehearsal/robots/map_offer.hpp"
#include "rehearsal/robots/random.hpp"
#include "rehearsal/robots/robot_map.hpp"

namespace adit::robots {

/// When a map is made: by the robot's own clock, and by the machine's.
struct MapTime {
  double stamp = 0;  // seconds
  Moment posted;
};

/// Makes a robot's maps from what it knows, in the forms of its offer. All of them are dated.
class MapMaker {
 public:
  MapMaker(const MapOffer& offer, std::uint64_t seed) : offer_(offer), random_(seed) {}

  static constexpr double kWindow = 10;  // metres, a rolling grid's side
  static constexpr double kTile = 8;     // metres, a tile's side
  /// Of drifting grids: metres by which an origin is off along each axis or not, metres up, radians of yaw.
  static constexpr double kDrift = 0.013, kRise = 0.001, kYaw = 1e-9;

  /// `here`: where the robot is. Nothing where it posts no grids.
  std::optional<Grid> grid(const RobotMap& map, const Vector3& here, const MapTime& time);
  /// Takes the map's new points. Nothing where there are none, or it posts no clouds.
  std::optional<Cloud> cloud(RobotMap& map, const Vector3& here, const MapTime& time);

  /// How many cells and points were made known so far, each counted once.
  std::uint64_t cells() const { return cells_.count(); }
  std::uint64_t points() const { return points_; }
  /// And places with points.
  std::uint64_t places() const { return places_.count(); }

 private:
  Grid window(const RobotMap& map, const Vector3& here, double stamp) const;
  Grid next_tile(const RobotMap& map, double stamp);
  void move_frame(Grid& grid);
  void fill(Cloud& cloud, std::size_t bytes, const Vector3& here);

  MapOffer offer_;
  Random random_;
  int tile_ = 0;   // whose turn it is
  int frame_ = 0;  // frames of drifting grids so far
  Cloud all_;      // of whole clouds
  KnownCells cells_;
  std::uint64_t points_ = 0;
  KnownPlaces places_;
};

}  // namespace adit::robots
