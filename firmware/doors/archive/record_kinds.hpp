#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/kept_runs.hpp"
#include "api/scene.hpp"
#include "loop/loop.hpp"
#include "picture/mosaic.hpp"

namespace adit::archive {

/// Largest record: a tile that cannot be compressed.
inline constexpr std::size_t kLargestRecord = std::size_t{72} << 10;

/// A record: a frame of store/ with a body, which must not be empty. Valid at any place of any file.
std::string frame_record(std::string_view body);

/// Calls `told` with the body of each complete record in `bytes`, in order. Skips damaged bytes up to the
/// next one or the end. Returns the number of damaged records, without a torn last one, which a kill leaves.
std::size_t for_each_record(std::string_view bytes, const std::function<void(std::string_view)>& told);

/// Queued records of tracks, plots and events. Each write costs a flush of the disk, so records without news
/// go with the next write, or after kRest.
class Lines {
 public:
  static constexpr std::chrono::seconds kRest{150};
  /// Most bytes of queued records, because a disk may be slow. Beyond that the oldest are dropped.
  static constexpr std::size_t kMost = std::size_t{256} << 10;

  /// News: a robot moved, or an alarm began or ended. Others show only that time passed.
  void add(std::string record, bool is_news);
  /// The oldest records, for one write.
  std::string pop(loop::Instant now);
  /// After a failed write of pop(): they are due at once.
  void give_back(std::string records);
  void make_due() { is_due_ = true; }
  bool is_due(loop::Instant now) const { return bytes_ > 0 && (is_due_ || now >= rests_until_); }
  void trim_to(std::size_t most);
  std::size_t bytes() const { return bytes_; }

 private:
  std::deque<std::string> records_;  // oldest first
  std::size_t bytes_ = 0;
  bool is_due_ = false;
  loop::Instant rests_until_{};
};

}  // namespace adit::archive

/// Bodies of records. A body that cannot be read gives std::nullopt.
namespace adit::archive {

/// First record of each file: its run, and the program's tile geometry, which another program may change.
struct Head {
  std::int64_t run = 0;
  double began = 0;
  std::string post = "";
  std::uint64_t side = picture::kSide, step = picture::kStep, levels = picture::kLevels;
  double pixel = picture::kPixel;

  /// Whether this program has the same tile geometry.
  bool tiles_fit() const {
    const Head ours;
    return side == ours.side && step == ours.step && levels == ours.levels && pixel == ours.pixel;
  }
};

/// A state of a tile. picture::Packer checks the stored crc.
struct TileState {
  picture::Layer layer;
  picture::TileIndex at = {};
  double stamp = 0;
  picture::Tile tile = {};  // null: blank
};

/// Records that the map was wiped at that time.
struct WipeRecord {
  double stamp = 0;
};

/// One sample of the plots.
struct Sample {
  api::Time at = 0;
  double sent_mbit = 0;
  std::uint64_t queued_bytes = 0;
  std::optional<double> scoring_ms = {}, mapping_ms = {};
  std::uint64_t throttled = 0;                                // since the previous sample
  std::vector<std::pair<std::string, double>> map_ages = {};  // by robot, seconds

  friend bool operator==(const Sample&, const Sample&) = default;
};

/// A clock step: earlier records of such files are later by `seconds`.
struct Step {
  double seconds = 0;  // negative: back
  double when = 0;     // monotonic; identifies a step that is recorded twice
  bool operator==(const Step&) const = default;
};

/// The kinds of records. Their positions are numbers in files: keep them and append new kinds. LayerView: a
/// layer without its tiles. Track: poses of one robot. AttentionStep: start or end of a need for attention.
using Record = std::variant<Head, TileState, picture::LayerView, WipeRecord, api::Track, Sample,
                            api::AttentionStep, Step>;

/// The framed record.
std::string record_of(const Record& record);
/// Reads any bytes: a complete value, or std::nullopt.
std::optional<Record> read(std::string_view body);

/// Most poses in a record, which then has 40 kB.
inline constexpr std::size_t kLargestPoses = 1000;
/// Most robots in a sample.
inline constexpr std::size_t kMostRobots = 128;
/// Most bytes of a name or a sentence; the rest is cut.
inline constexpr std::size_t kMostText = 400;

}  // namespace adit::archive
