#include "archive/run_records.hpp"

#include <algorithm>

namespace adit::archive {

void RunRecords::tell(std::string_view bytes, std::uint64_t file) {
  damaged_ += for_each_record(bytes, [&](std::string_view record) {
    const auto known = read(record);
    if (known && (is_ours_ || std::holds_alternative<Head>(*known)))
      std::visit([&](const auto& one) { add(one, file); }, *known);
  });
}

void RunRecords::add(const picture::LayerView& view, std::uint64_t /*file*/) {
  if (tiles_fit_) picture_.take_up(view);
}

void RunRecords::add(const Wiped& wiped, std::uint64_t /*file*/) {
  picture_.was_wiped(wiped.stamp);
}

/// A sample, or a need for attention.
template <class Line>
void RunRecords::add(const Line& line, std::uint64_t /*file*/) {
  last_line_ = std::max(last_line_, line.at);
  samples_.add(line);
}

/// Line files and tile files are read separately, so each records every step. A step may be recorded again
/// after a failed write.
void RunRecords::add(const Step& step, std::uint64_t file) {
  const bool of_tiles = file != 0;
  std::vector<Step>& told = of_tiles ? tile_steps_ : line_steps_;
  if (std::ranges::find(told, step) != told.end()) return;
  told.push_back(step);
  if (of_tiles) return move_tiles(step.seconds);
  move_lines(step.seconds);
}

void RunRecords::move(double seconds) {
  move_lines(seconds);
  move_tiles(seconds);
}

void RunRecords::move_lines(double seconds) {
  samples_.move(seconds);
  for (auto& [robot, poses] : tracks_) {
    for (api::TrackPose& pose : poses) pose.at += seconds;
  }
  last_line_ += seconds;
}

void RunRecords::move_tiles(double seconds) {
  picture_.move(seconds);
  last_tile_ += seconds;
}

/// The first head identifies the run; files of other runs are ignored. A file with a damaged head counts like
/// the file before it.
void RunRecords::add(const Head& head, std::uint64_t /*file*/) {
  if (!head_) head_ = head;
  is_ours_ = head_->run == head.run && head_->began == head.began;
  tiles_fit_ = head.tiles_fit();
}

void RunRecords::add(const TileState& state, std::uint64_t file) {
  const bool is_readable = !state.tile || packer_.is_whole(*state.tile);
  if (!tiles_fit_ || !is_readable || !picture_.take_up(state.layer, state.at, state.tile, state.stamp))
    return;
  last_tile_ = std::max(last_tile_, state.stamp);
  files_[{state.layer, state.at}] = file;
}

void RunRecords::add(const api::Track& track, std::uint64_t /*file*/) {
  auto& poses = tracks_[track.robot];
  for (const api::TrackPose& pose : track.poses) {
    if (poses_ == kMostPoses || (!poses.empty() && pose.at <= poses.back().at)) continue;
    poses.push_back(pose);
    last_line_ = std::max(last_line_, pose.at);
    ++poses_;
  }
}

std::vector<api::Track> RunRecords::tracks() const {
  std::vector<api::Track> tracks;
  for (const auto& [robot, poses] : tracks_) {
    if (!poses.empty()) tracks.push_back({robot, poses});
  }
  return tracks;
}

}  // namespace adit::archive
