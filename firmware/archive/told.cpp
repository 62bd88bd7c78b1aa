#include "archive/told.hpp"

#include <algorithm>
#include <utility>

namespace adit::archive {

void Told::tell(std::string_view bytes, std::uint64_t file) {
  damaged_ += for_each_record(bytes, [&](Kind kind, std::string_view said) { tell(kind, said, file); });
}

void Told::tell(Kind kind, std::string_view said, std::uint64_t file) {
  if (kind == Kind::Head) return tell_head(said);
  if (!is_ours_) return;
  switch (kind) {
    case Kind::Tile:
      if (auto state = read_tile(said)) tell(std::move(*state), file);
      return;
    case Kind::Layer:
      if (const auto view = read_layer(said); view && tiles_fit_) picture_.take_up(*view);
      return;
    case Kind::Wiped:
      if (const auto stamp = read_time(said)) picture_.was_wiped(*stamp);
      return;
    case Kind::Poses:
      if (const auto track = read_poses(said)) tell(*track);
      return;
    case Kind::Sample:
      if (auto sample = read_sample(said)) {
        last_line_ = std::max(last_line_, sample->at);
        samples_.add(std::move(*sample));
      }
      return;
    case Kind::Attention:
      if (auto step = read_attention(said)) {
        last_line_ = std::max(last_line_, step->at);
        samples_.add(std::move(*step));
      }
      return;
    case Kind::Moved:
      if (const auto step = read_step(said)) tell(*step, file != 0);
      return;
    case Kind::Head:
      return;
  }
}

/// The files of lines and those of tiles are read apart, so each tells it. After a write that failed, its
/// steps are told again.
void Told::tell(const Step& step, bool of_tiles) {
  std::vector<Step>& told = of_tiles ? tile_steps_ : line_steps_;
  if (std::ranges::find(told, step) != told.end()) return;
  told.push_back(step);
  if (of_tiles) return move_tiles(step.seconds);
  move_lines(step.seconds);
}

void Told::move(double seconds) {
  move_lines(seconds);
  move_tiles(seconds);
}

void Told::move_lines(double seconds) {
  samples_.move(seconds);
  for (auto& [robot, poses] : tracks_) {
    for (api::TrackPose& pose : poses) pose.at += seconds;
  }
  last_line_ += seconds;
}

void Told::move_tiles(double seconds) {
  picture_.move(seconds);
  for (auto& [at, pixels] : known_) at += seconds;
  last_tile_ += seconds;
}

/// The first one says whose run it is. Files of another one, which somebody put there, are not told. A file
/// whose head is damaged is taken for what the one before was.
void Told::tell_head(std::string_view said) {
  const auto read = read_head(said);
  if (!read) return;
  if (!head_) head_ = read->head;
  is_ours_ = head_->run == read->head.run && head_->began == read->head.began;
  tiles_fit_ = read->tiles_fit;
}

void Told::tell(TileState state, std::uint64_t file) {
  const auto known = state.tile ? packer_.known_in(*state.tile) : 0;
  if (!tiles_fit_ || !known || !picture_.take_up(state.layer, state.at, state.tile, state.stamp)) return;
  last_tile_ = std::max(last_tile_, state.stamp);
  const TileKey key{state.layer, state.at};
  files_[key] = file;
  if (state.at.level > 0) return;
  std::size_t& before = known_of_[key];
  known_now_ += *known - before;
  before = *known;
  if (known_.empty() || known_.back().first < state.stamp) known_.emplace_back(state.stamp, 0);
  known_.back().second = known_now_;
}

void Told::tell(const api::Track& track) {
  auto& poses = tracks_[track.robot];
  for (const api::TrackPose& pose : track.poses) {
    if (poses_ == kMostPoses || (!poses.empty() && pose.at <= poses.back().at)) continue;
    poses.push_back(pose);
    last_line_ = std::max(last_line_, pose.at);
    ++poses_;
  }
}

std::vector<api::Track> Told::tracks() const {
  std::vector<api::Track> tracks;
  for (const auto& [robot, poses] : tracks_) {
    if (!poses.empty()) tracks.push_back({robot, poses});
  }
  return tracks;
}

}  // namespace adit::archive
