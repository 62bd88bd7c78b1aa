#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/scene.hpp"
#include "archive/due_tiles.hpp"
#include "archive/framed_records.hpp"
#include "archive/record_kinds.hpp"
#include "archive/samples.hpp"
#include "picture/mosaic.hpp"

namespace adit::archive {

/// The sum of a run's records. Accepts any bytes and skips data that is not a record of this run.
class RunRecords {
 public:
  static constexpr std::size_t kMostPoses = 100'000;

  /// `budget`: most bytes of the map.
  explicit RunRecords(std::size_t budget) : picture_(budget) {}

  /// Adds one file. `file`: number of a tile file, or 0 for a line file.
  void tell(std::string_view bytes, std::uint64_t file);
  /// Call if the time of day was advanced by `seconds`.
  void move(double seconds);

  const std::optional<Head>& head() const { return head_; }
  picture::Mosaic& picture() { return picture_; }
  std::vector<api::Track> tracks() const;
  Samples& samples() { return samples_; }
  /// The file of each tile's newest state.
  std::map<TileKey, std::uint64_t>& files() { return files_; }
  std::size_t damaged() const { return damaged_; }                  // records
  double last() const { return std::max(last_line_, last_tile_); }  // latest time in the records

 private:
  // `file`: 0 for a line file, else a tile file.
  void add(const Head& head, std::uint64_t file);
  void add(const TileState& state, std::uint64_t file);
  void add(const picture::LayerView& view, std::uint64_t file);
  void add(const Wiped& wiped, std::uint64_t file);
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
