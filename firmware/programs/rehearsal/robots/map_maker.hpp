#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/agreed.hpp"
#include "rehearsal/robots/cave.hpp"
#include "rehearsal/robots/messages.hpp"
#include "rehearsal/robots/robot.hpp"

namespace adit::robots {

// Maps hold the time of their posting by the machine's clock, so that a rehearsal Command Post can measure
// their age at arrival, even if they were merged or stitched on their way (rehearsal/README.md, 'How old').
// The two programs share no code: the Command Post reads it by rules of its own.

using Moment = std::chrono::sys_time<std::chrono::milliseconds>;

/// Puts the moment into the first ten cells of the lowest row: five that say so, and five digits to the base
/// 101, the highest first, of the milliseconds since 1970 modulo 101^5 (121 days). A narrower grid stays.
void date(Grid& grid, Moment posted);

/// Adds to each point `posted_ms`, uint32: the milliseconds since 1970 modulo 2^32.
void date(Cloud& cloud, Moment posted);

/// What a robot's grids show: all that it knows; the same in a frame that SLAM corrects each time; the 10 m
/// about it; or one tile of what it knows after the other.
enum class GridForm : std::uint8_t { Whole, Drifting, Rolling, Tiles, None };

/// What a robot's clouds hold: the points that are new since the last one; or all of them each time.
enum class CloudForm : std::uint8_t { Differential, Whole, None };

/// The maps that one robot posts.
struct MapOffer {
  GridForm grids = GridForm::Whole;
  CloudForm clouds = CloudForm::Differential;
  std::chrono::duration<double> grid_every{1}, cloud_every{1};
  std::size_t grid_bytes = 0;   // of a grid of the whole cave, about; 0: as the cave is
  std::size_t cloud_bytes = 0;  // of a cloud at least; 0: what the lidar saw
};

/// The maps that a team posts: the robots take the forms in turn.
struct MapOffers {
  std::vector<GridForm> grids = {GridForm::Whole};
  std::vector<CloudForm> clouds = {CloudForm::Differential};
  std::optional<double> grid_hz, cloud_hz;  // absent: once a second; every 1, 0.5 or 2 s in turn
  double grid_mb = 0, cloud_mb = 0;         // megabytes

  MapOffer of(std::size_t robot) const;
  bool has_grids() const;
  bool has_clouds() const;
};

/// "whole,tiles": forms with commas between them.
std::expected<std::vector<GridForm>, std::string> parse_grid_forms(std::string_view text);
std::expected<std::vector<CloudForm>, std::string> parse_cloud_forms(std::string_view text);

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
