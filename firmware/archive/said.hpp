#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/kept_runs.hpp"
#include "api/scene.hpp"
#include "picture/mosaic.hpp"

/// What records say, and what is read of them: nothing, where it cannot be.
namespace adit::archive {

/// Of each file: whose run it is of. How tiles are cut is the program's: another may cut them in another way.
struct Head {
  std::int64_t run = 0;
  double began = 0;
  std::string post = "";
  std::uint64_t side = picture::kSide, step = picture::kStep, levels = picture::kLevels;
  double pixel = picture::kPixel;

  /// They are cut as this program cuts them.
  bool tiles_fit() const {
    const Head ours;
    return side == ours.side && step == ours.step && levels == ours.levels && pixel == ours.pixel;
  }
};

/// A state of a tile. Its crc is as it was written: picture::Packer says whether it is a tile.
struct TileState {
  picture::Layer layer;
  picture::TileAt at = {};
  double stamp = 0;
  picture::Tile tile = {};  // null: blank
};

/// The picture was blank at that time.
struct Wiped {
  double stamp = 0;
};

/// One moment of the plots.
struct Sample {
  api::Time at = 0;
  double sent_mbit = 0;
  std::uint64_t queued_bytes = 0;
  std::optional<double> scoring_ms = {}, mapping_ms = {};
  std::uint64_t throttled = 0;                                // since the sample before
  std::vector<std::pair<std::string, double>> map_ages = {};  // by robot, seconds

  friend bool operator==(const Sample&, const Sample&) = default;
};

/// The time of day was set: all that such files told before is of so many seconds later.
struct Step {
  double seconds = 0;  // ahead; less than 0: back
  double when = 0;     // by a clock that is never set; identifies a step that is recorded twice
  bool operator==(const Step&) const = default;
};

/// One of these, whose place is a number in files: they stay, and others come behind them. Of a layer all but
/// its tiles; the poses of one robot; that something which needs the operator came, or went.
using Said =
    std::variant<Head, TileState, picture::LayerView, Wiped, api::Track, Sample, api::AttentionStep, Step>;

/// A record of it.
std::string record_of(const Said& said);
/// Whatever bytes a record has: what they say in full, or nothing.
std::optional<Said> read(std::string_view said);

/// Poses in one record, at most: it then has 40 kB.
inline constexpr std::size_t kLargestPoses = 1000;
/// Robots in one sample, at most.
inline constexpr std::size_t kMostRobots = 128;
/// Bytes of a name or of a sentence, at most: longer ones are cut.
inline constexpr std::size_t kMostText = 400;

}  // namespace adit::archive
