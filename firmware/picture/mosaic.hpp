#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "picture/draw.hpp"
#include "picture/history.hpp"

namespace adit::picture {

/// One tile of a layer.
struct TileView {
  TileAt at;
  double first = 0;           // when it was first drawn
  double stamp = 0;           // when it was last drawn
  std::uint64_t version = 0;  // of its newest state
  bool blank = false;         // it was wiped since
};

/// Of which level a layer's tiles can be had besides, and what of these changed.
struct Finer {
  int level = 0;              // the finest: -1 or -2
  std::uint64_t version = 0;  // of the last change
  std::optional<Area> area;   // that changed
};

/// A layer, and those of its tiles that changed.
struct LayerView {
  Layer layer;
  std::optional<Area> bounds;  // of all that was drawn since the last wipe
  std::optional<Heights> heights;
  double first = 0, last = 0;  // when its first and its last map came
  std::uint64_t version = 0;   // of the last change
  std::size_t missed = 0;      // maps that are not in it
  std::size_t left_out = 0;    // Drawing::left_out of the last map
  std::vector<TileView> tiles;
  std::optional<Finer> finer;  // ForwardedGrids' word
};

/// The picture of all maps: its layers, their tiles, and how these were at earlier times. Does no more than
/// hand tiles about; drawing them is draw()'s.
///
/// Keeps at most `budget` bytes: the older states of tiles are thinned out evenly over time, down to the
/// newest alone; a drawing whose newest tiles would not fit is refused as a whole. Times are seconds since
/// 1970.
class Mosaic {
 public:
  static constexpr std::size_t kBudget = std::size_t{32} << 20;
  static constexpr std::size_t kMostLayers = 64;

  explicit Mosaic(std::size_t budget = kBudget) : budget_(budget) {}

  /// What the next map of that layer is to be drawn upon. A layer's drawings are made and applied one after
  /// the other, each upon a canvas of its own.
  Canvas canvas(const Layer& layer) const;

  /// Takes a drawing of what came at `stamp`; never a time before the last. False, and missed, where there is
  /// no room for it; false also where it was begun before the last wipe, and belongs to the run before.
  bool apply(Drawing drawing, double stamp);
  /// A map of that layer came that will not be drawn.
  void missed(const Layer& layer, double stamp);
  /// Something that is shown with this changed: gives its version.
  std::uint64_t count_change(double stamp) {
    begin_change(stamp);
    return version_;
  }
  /// A new run: from now on all is blank. Earlier times stay as they were.
  void wipe(double stamp);

  /// The time of day was set ahead by so many seconds: all of it came as long ago as it did.
  void move(double seconds);

  /// A state of a tile as it was before a restart, which comes in the order of its tile's states. False where
  /// that order is broken, or there is no room for it.
  bool take_up(const Layer& layer, const TileAt& at, Tile tile, double stamp);
  /// What is known of a layer beside its tiles.
  void take_up(const LayerView& view);
  void was_wiped(double stamp) { wiped_ = stamp; }
  /// All that `earlier` has: its layers as they are now, and its earlier times where this has none. What is
  /// drawn here already stays. At `stamp` all of it counts as changed.
  void take_up(Mosaic earlier, double stamp);

  /// The tile as of `stamp` (absent: now), which is newest or not; null where nothing is drawn there.
  struct Shown {
    Tile tile;
    bool newest = false;
    double stamp = 0;             // since when it is so
    std::optional<double> until;  // when another followed; nothing: it is the newest
  };
  Shown tile(const Layer& layer, const TileAt& at, std::optional<double> stamp) const;

  /// Every layer, with the tiles that changed after that version; 0: all.
  std::vector<LayerView> layers(std::uint64_t since = 0) const;

  /// Grows with every change, over restarts too: it is the time of the change in milliseconds, or one more
  /// than the last. 0: nothing was drawn yet.
  std::uint64_t version() const { return version_; }
  std::optional<double> wiped() const { return wiped_; }  // when last
  double spacing() const { return spacing_; }             // of earlier states, in seconds: see History
  std::size_t bytes() const { return bytes_; }

 private:
  struct State {
    LayerView view;  // without its tiles
    std::map<TileAt, History> tiles;
  };
  State* state_of(const Layer& layer, double stamp);
  double begin_change(double stamp);
  void take_up(State& state, const TileAt& at, const History& earlier, double stamp);
  bool has_room(const State& state, const Drawing& drawing) const;
  void put(State& state, const TileAt& at, Tile tile, double stamp);
  void keep_to_budget();

  std::size_t budget_;
  std::map<Layer, State> layers_;
  std::size_t bytes_ = 0, newest_bytes_ = 0;  // of all states, and of the newest alone
  double spacing_ = 1;
  double last_ = 0;  // the last stamp
  std::uint64_t version_ = 0, run_ = 0;
  std::optional<double> wiped_;
};

}  // namespace adit::picture
