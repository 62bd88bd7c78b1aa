#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/history.hpp"
#include "api/scene.hpp"
#include "picture/mosaic.hpp"

/// What records say, and what is read of them: nothing, where it cannot be.
namespace adit::archive {

/// Of each file. How tiles are cut is the program's: another may cut them in another way.
struct Head {
  std::int64_t run = 0;
  double began = 0;
  std::string post = "";
};
std::string said(const Head& head);
struct HeadRead {
  Head head;
  bool tiles_fit = false;  // they are cut as this program cuts them
};
std::optional<HeadRead> read_head(std::string_view said);

/// A state of a tile.
struct TileState {
  picture::Layer layer;
  picture::TileAt at = {};
  double stamp = 0;
  picture::Tile tile = {};  // null: blank
};
std::string said(const TileState& state);
/// Its crc is as it was written: picture::Packer says whether it is a tile.
std::optional<TileState> read_tile(std::string_view said);

/// Without its tiles.
std::string said(const picture::LayerView& view);
std::optional<picture::LayerView> read_layer(std::string_view said);

std::string said_time(double stamp);
std::optional<double> read_time(std::string_view said);
/// The time of day was set.
struct Step {
  double seconds = 0;  // ahead; less than 0: back
  double when = 0;     // by a clock that nobody sets: a step that is told twice is one
  bool operator==(const Step&) const = default;
};
std::string said(const Step& step);
std::optional<Step> read_step(std::string_view said);

std::string said(const std::string& robot, std::span<const api::TrackPose> poses);
std::optional<api::Track> read_poses(std::string_view said);

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
std::string said(const Sample& sample);
std::optional<Sample> read_sample(std::string_view said);

std::string said(const api::AttentionStep& step);
std::optional<api::AttentionStep> read_attention(std::string_view said);

/// Poses in one record, at most: it then has 40 kB.
inline constexpr std::size_t kLargestPoses = 1000;
/// Robots in one record, at most.
inline constexpr std::size_t kMostRobots = 128;
/// Bytes of a name or of a sentence, at most: longer ones are cut.
inline constexpr std::size_t kMostText = 400;

}  // namespace adit::archive
