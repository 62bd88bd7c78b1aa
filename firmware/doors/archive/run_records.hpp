#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/kept_runs.hpp"
#include "api/scene.hpp"
#include "archive/record_kinds.hpp"
#include "picture/mosaic.hpp"

namespace adit::archive {

/// Identifies a tile of the map.
using TileKey = std::pair<picture::Layer, picture::TileIndex>;

/// Decides which tiles to write next: changed ones, each at most once per interval_of() its level. The
/// interval keeps coarse tiles, which change with every fine one below, from displacing fine ones. Order:
/// never written, then the oldest write first.
///
/// Also tracks the file of each tile's newest state, because a file without newest states may be removed.
class DueTiles {
 public:
  /// Seconds between two writes of a tile: 4 for the finest level, 4 times as many for each coarser one.
  static double interval_of(int level);

  /// Marks tiles that changed since the last look.
  void mark_changed(const picture::Mosaic& picture);
  /// Tiles to write at `now` (seconds that never step), in order.
  std::vector<TileKey> at(double now) const;
  /// Records that write number `write` takes the tile's state at `now`.
  void record_write(const TileKey& tile, std::uint64_t write, double now);
  /// Records the write's file. std::nullopt: the write failed, and its tiles are due again.
  void on_written(std::uint64_t write, std::optional<std::uint64_t> file);
  /// Makes the tiles of that file due, so that the file can be removed. True: it has no newest states.
  bool release_file(std::uint64_t file);
  /// Starts with the tiles of `picture` that are stored in `files`.
  void begin(const picture::Mosaic& picture, const std::map<TileKey, std::uint64_t>& files);

 private:
  struct Tile {
    double written = 0;       // 0: never
    std::uint64_t file = 0;   // 0: none
    std::uint64_t write = 0;  // in flight; 0: none
    bool due = false;
  };
  std::map<TileKey, Tile> tiles_;
  std::uint64_t seen_ = 0;  // Mosaic::version()
};

/// The plots of a run, with a sample every kSpacing seconds. At kMost samples every second one is dropped,
/// and the spacing doubles. The event count of a dropped sample is added to the next one.
class Samples {
 public:
  static constexpr double kSpacing = 2;       // seconds
  static constexpr std::size_t kMost = 3600;  // two hours at first
  static constexpr double kEarly = 0.5;       // seconds of tolerance, because ticks jitter
  static constexpr std::size_t kMostSteps = 2000;

  /// Whether a sample is due at that time.
  bool is_due(api::Time at) const { return samples_.empty() || at >= samples_.back().at + spacing_ - kEarly; }
  /// Ignores a sample that is not later than the last one.
  void add(Sample sample);
  /// Beyond kMostSteps the oldest is dropped.
  void add(api::AttentionStep step);
  void clear() { *this = Samples(); }
  /// Call if the time of day was advanced by `seconds`.
  void move(double seconds);

  api::History history_after(api::Time since) const;

 private:
  void thin();

  double spacing_ = kSpacing;
  std::deque<Sample> samples_;  // oldest first
  std::deque<api::AttentionStep> steps_;
};

/// The present needs for attention.
class Attention {
 public:
  static constexpr std::size_t kMost = 100;  // at the same time

  /// Returns the changes since the last look.
  std::vector<api::AttentionStep> update(const std::vector<std::string>& sentences, api::Time now);
  /// `steps`: from before a restart. Needs that had not ended continue.
  void restore(const std::vector<api::AttentionStep>& steps);
  void clear() { *this = Attention(); }

 private:
  std::vector<std::string> shown_;
};

/// The sum of a run's records. Accepts any bytes and skips data that is not a record of this run.
class RunRecords {
 public:
  static constexpr std::size_t kMostPoses = 100'000;

  /// `budget`: most bytes of the map.
  explicit RunRecords(std::size_t budget) : picture_(budget) {}

  /// Adds one file. `file`: number of a tile file, or 0 for a line file.
  void add_file(std::string_view bytes, std::uint64_t file);
  /// Call if the time of day was advanced by `seconds`.
  void move(double seconds);

  const std::optional<Head>& head() const { return head_; }
  picture::Mosaic& picture() { return picture_; }
  std::vector<api::Track> tracks() const;
  Samples& samples() { return samples_; }
  /// The file of each tile's newest state.
  std::map<TileKey, std::uint64_t>& files() { return files_; }
  std::size_t damaged_records() const { return damaged_; }          // records
  double last() const { return std::max(last_line_, last_tile_); }  // latest time in the records

 private:
  // `file`: 0 for a line file, else a tile file.
  void add(const Head& head, std::uint64_t file);
  void add(const TileState& state, std::uint64_t file);
  void add(const picture::LayerView& view, std::uint64_t /*file*/) {
    if (tiles_fit_) picture_.restore(view);
  }
  void add(const WipeRecord& wiped, std::uint64_t /*file*/) { picture_.set_wipe_time(wiped.stamp); }
  void add(const api::Track& track, std::uint64_t file);
  template <class Line>
  void add(const Line& line, std::uint64_t file);
  void add(const Step& step, std::uint64_t file);
  void move_lines(double seconds);
  void move_tiles(double seconds);

  picture::Mosaic picture_;
  picture::Packer packer_;
  Samples samples_;
  std::optional<Head> head_;
  bool tiles_fit_ = false;
  bool is_ours_ = false;
  std::size_t damaged_ = 0;
  std::map<std::string, std::vector<api::TrackPose>> tracks_;
  std::size_t poses_ = 0;
  std::map<TileKey, std::uint64_t> files_;
  double last_line_ = 0, last_tile_ = 0;
  std::vector<Step> line_steps_, tile_steps_;  // already applied
};

}  // namespace adit::archive
