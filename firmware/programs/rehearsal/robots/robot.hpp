#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rehearsal/agreed.hpp"
#include "rehearsal/robots/cave.hpp"
#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// One robot's knowledge: how surely each cell is rock, and the lidar's points since they were last taken.
class RobotMap {
 public:
  explicit RobotMap(const Lattice& lattice);

  const Lattice& lattice() const { return cells_.lattice(); }
  bool is_known(Cell cell) const { return cells_[cell] != kUnknown; }
  bool is_free(Cell cell) const { return cells_[cell] < 50; }
  bool is_rock(Cell cell) const { return cells_[cell] > 50 && cells_[cell] != kUnknown; }

  /// Sweeps a lidar once round from `from`: cells become surer each time, and new ones add their points.
  void sweep(const Cave& cave, const Vector3& from, Random& random);

  /// The whole map: the rectangle of known cells; each covers the one before it. Requires a sweep.
  Grid grid(double stamp) const;

  /// The known state of the cells from `low` to `high`, both included, which may lie outside of the cave.
  Grid part(Cell low, Cell high, double stamp) const;
  /// The corners of the known cells, both included. Before the first sweep, low() is above high().
  Cell low() const { return low_; }
  Cell high() const { return high_; }

  /// The points measured since the last call (x, y, z, intensity as float32), each once.
  Cloud take_new_points(double stamp);

 private:
  void see_floor(const Cave& cave, Cell cell, Random& random);
  void see_rock(Cell cell, double floor, double ceiling, Random& random);
  void see_point(double x, double y, double z, double intensity, Random& random);
  void include(Cell cell);

  Raster<std::uint8_t> cells_;
  Cell low_, high_;  // inclusive; of the known cells
  std::vector<float> points_;
};

/// Whether the robot's body fits: the cell is free and no cell beside it is rock.
bool is_walkable(const RobotMap& map, Cell cell);

/// Whether what lies beside a walkable cell is not known yet.
bool is_frontier(const RobotMap& map, Cell cell);

/// The way from `start`, over walkable cells wherever it can, to the best frontier: near, and in the
/// direction `heading` (radians) that this robot prefers, so that a team spreads out. If all is explored, the
/// way to some place that `random` chooses. Empty if there is no way.
std::vector<Cell> exploration_path(const RobotMap& map, Cell start, double heading, Random& random);

/// One robot in the cave: it walks to what it does not know yet, sees with its lidar, and notices artifacts
/// that come near. Reads no clock: time passes in advance().
class Robot {
 public:
  /// `cave` outlives the robot. The same seed and index give the same walk.
  Robot(const Cave& cave, std::uint64_t seed, std::size_t index);

  static constexpr double kSightRange = 7;  // metres at which it knows an artifact

  /// Walks `metres` and looks round once.
  void advance(double metres);

  Placement pose() const;
  double walked_distance() const { return walked_; }  // metres in all
  RobotMap& map() { return map_; }

  /// Indices in cave.artifacts() of those seen since the last call, each once in a robot's life.
  std::vector<std::size_t> take_sightings() { return std::exchange(sightings_, {}); }

 private:
  void step(double metres);
  void detect_artifacts();

  const Cave& cave_;
  Random random_;
  RobotMap map_;
  double x_, y_, yaw_, preferred_;
  double walked_ = 0;
  std::vector<Cell> way_;  // the next cell is the last
  std::vector<bool> noticed_;
  std::vector<std::size_t> sightings_;
};

// Maps hold the time of their posting by the machine's clock, so that a rehearsal Command Post can measure
// their age at arrival, even if they were merged or stitched on their way (rehearsal/README.md, 'How old').

/// Puts the moment into the first ten cells of the lowest row (kDateFollows). A narrower grid stays.
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

  MapOffer offer_of(std::size_t robot) const;
  bool has_grids() const { return std::ranges::count(grids, GridForm::None) < std::ssize(grids); }
  bool has_clouds() const { return std::ranges::count(clouds, CloudForm::None) < std::ssize(clouds); }
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

  /// `here`: the robot's place. std::nullopt if it posts no grids.
  std::optional<Grid> grid(const RobotMap& map, const Vector3& here, const MapTime& time);
  /// Takes the map's new points. std::nullopt if there are none, or it posts no clouds.
  std::optional<Cloud> cloud(RobotMap& map, const Vector3& here, const MapTime& time);

  const MapOffer& offer() const { return offer_; }

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
