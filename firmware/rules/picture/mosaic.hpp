#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "picture/draw.hpp"
#include "picture/tile.hpp"

namespace adit::picture {

/// The state of a tile from `stamp` on.
struct Version {
  double stamp = 0;          // seconds since 1970
  std::uint64_t number = 0;  // Mosaic::version() of this change
  Tile tile;
};

/// Approximate memory of a version.
std::size_t cost_of(const Version& version);

/// One tile over time. Time is divided into spans of `spacing` seconds. Only the last version of each span is
/// kept, so the version shown for any time is at most `spacing` old. A span of twice the length covers two of
/// these, so repeated thinning gives the same result as the final spacing from the start.
class History {
 public:
  /// Requires a stamp that is not before the newest.
  void add(Version version, double spacing);
  void thin(double spacing);
  /// Shifts all stamps: the time of day was set ahead by `seconds`.
  void move(double seconds) {
    for (Version& version : versions_) version.stamp += seconds;
  }
  /// Gives the newest version this number.
  void renumber(std::uint64_t number) { versions_.back().number = number; }

  /// The version at that time, or null if there was none yet.
  const Version* at(double stamp) const;
  /// When another version followed; nullopt: it is the newest.
  std::optional<double> end_of(const Version& version) const;
  const Version& first() const { return versions_.front(); }
  const Version& newest() const { return versions_.back(); }
  const std::vector<Version>& versions() const { return versions_; }  // oldest first
  bool empty() const { return versions_.empty(); }
  std::size_t cost() const { return cost_; }

 private:
  std::vector<Version> versions_;  // oldest first
  std::size_t cost_ = 0;
};

struct TileView {
  TileIndex at;
  double first = 0;           // time of its first drawing
  double stamp = 0;           // time of its last drawing
  std::uint64_t version = 0;  // of its newest state
  bool blank = false;         // it was wiped since
};

/// The finer levels of a layer, and their changes.
struct FinerLevels {
  int level = 0;              // the finest: -1 or -2
  std::uint64_t version = 0;  // of the last change
  std::optional<Area> area;   // that changed
};

/// A layer and those of its tiles that changed.
struct LayerView {
  Layer layer;
  std::optional<Area> bounds;  // of everything drawn since the last wipe
  std::optional<Heights> heights;
  double first = 0, last = 0;  // times of its first and last map
  std::uint64_t version = 0;   // of the last change
  std::size_t missed = 0;      // maps that are not in it
  std::size_t left_out = 0;    // Drawing::left_out of the last map
  std::vector<TileView> tiles;
  std::optional<FinerLevels> finer;  // from ForwardedGrids
};

/// The picture of all maps: layers, tiles, and earlier states of tiles. It stores tiles; draw() makes them.
///
/// Keeps at most `budget` bytes. Beyond that, older states of tiles are thinned out evenly over time, down to
/// the newest. A drawing is rejected as a whole if its newest tiles do not fit. Times: seconds since 1970.
class Mosaic {
 public:
  static constexpr std::size_t kBudget = std::size_t{32} << 20;
  static constexpr std::size_t kMostLayers = 64;

  explicit Mosaic(std::size_t budget = kBudget) : budget_(budget) {}

  /// For the next map of that layer. Make and apply a layer's drawings one by one, each on a new canvas.
  Canvas canvas(const Layer& layer) const;

  /// Adds the drawing of a map that came at `stamp`, or at the last one if later. False if there is no room
  /// for it or its layer (it counts as missed), or if it was begun before the last wipe.
  bool apply(Drawing drawing, double stamp);
  /// A map of that layer came and will not be drawn.
  void on_missed(const Layer& layer, double stamp);
  /// Counts a change of something that is shown with the picture, and returns its version.
  std::uint64_t count_change(double stamp) {
    begin_change(stamp);
    return version_;
  }
  /// Starts a new run: all tiles are blank from now on. Earlier times stay.
  void wipe(double stamp);

  /// Shifts all times: the time of day was set ahead by `seconds`.
  void move(double seconds);

  /// Restores a tile's state from before a restart, in the states' order. False: wrong order, or no room.
  bool restore(const Layer& layer, const TileIndex& at, Tile tile, double stamp);
  /// Restores the data of a layer, except its tiles.
  void restore(const LayerView& view);
  void set_wipe_time(double stamp) { wiped_ = stamp; }
  /// Adds all of `earlier`: its present layers, and earlier states of tiles that are not drawn here. Tiles
  /// that are drawn here stay. Added tiles count as changed at `stamp`.
  void restore(Mosaic earlier, double stamp);

  /// The tile at `stamp` (absent: now). `tile` is null if nothing is drawn there.
  struct ShownTile {
    Tile tile;
    bool newest = false;
    double stamp = 0;             // the start of this state
    std::optional<double> until;  // when the next state followed; nullopt: it is the newest
  };
  ShownTile tile(const Layer& layer, const TileIndex& at, std::optional<double> stamp) const;

  /// Grids' base tiles by place and robot, of places that changed after `since`. Valid until the next change.
  std::map<TileIndex, std::vector<std::pair<std::string, const History*>>> grid_places(
      std::uint64_t since) const;
  /// False if a grid of this run, or a part of a robot's last one, is not in the picture.
  bool has_all_grids() const;

  /// All layers, with the tiles that changed after version `since` (0: all tiles).
  std::vector<LayerView> layers(std::uint64_t since = 0) const;

  /// Grows with every change, also across restarts: the time of the change in milliseconds, or the previous
  /// version plus one. 0: nothing was drawn yet.
  std::uint64_t version() const { return version_; }
  std::optional<double> wipe_time() const { return wiped_; }  // time of the last wipe
  double spacing() const { return spacing_; }                 // of earlier states, in seconds: see History
  std::size_t bytes() const { return bytes_; }
  /// Maps of this run whose layer is one too many.
  std::size_t missed_maps() const { return missed_; }

 private:
  struct State {
    LayerView view;  // without its tiles
    std::map<TileIndex, History> tiles;
  };
  State* state_of(const Layer& layer, double stamp);
  double begin_change(double stamp);
  void restore(State& state, const TileIndex& at, const History& earlier, double stamp);
  bool has_room(const State& state, const Drawing& drawing) const;
  void put(State& state, const TileIndex& at, Tile tile, double stamp);
  void keep_to_budget();

  std::size_t budget_;
  std::map<Layer, State> layers_;
  std::size_t missed_ = 0;
  std::size_t bytes_ = 0, newest_bytes_ = 0;  // of all states; of the newest states
  double spacing_ = 1;
  double last_ = 0;  // the last stamp
  std::uint64_t version_ = 0, run_ = 0;
  std::optional<double> wiped_;
};

}  // namespace adit::picture
