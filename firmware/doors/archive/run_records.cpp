#include "archive/run_records.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace adit::archive {

double DueTiles::interval_of(int level) {
  constexpr double kFinest = 4;
  return kFinest * std::pow(4, level);
}

void DueTiles::mark_changed(const picture::Mosaic& picture) {
  if (picture.version() == seen_) return;
  for (const picture::LayerView& layer : picture.layers(seen_)) {
    for (const picture::TileView& tile : layer.tiles) {
      Tile& known = tiles_[{layer.layer, tile.at}];
      // A blank tile belongs to an earlier run, unless this run wrote it.
      known.due = !tile.blank || known.written != 0;
    }
  }
  seen_ = picture.version();
}

std::vector<TileKey> DueTiles::at(double now) const {
  std::vector<std::pair<double, const TileKey*>> order;
  for (const auto& [key, tile] : tiles_) {
    const bool rests = tile.written != 0 && now < tile.written + interval_of(key.second.level);
    if (tile.due && !rests) order.emplace_back(tile.written, &key);
  }
  std::ranges::stable_sort(order, {}, &std::pair<double, const TileKey*>::first);
  std::vector<TileKey> keys;
  keys.reserve(order.size());
  for (const auto& [written, key] : order) keys.push_back(*key);
  return keys;
}

void DueTiles::record_write(const TileKey& tile, std::uint64_t write, double now) {
  Tile& its = tiles_[tile];
  its.written = now;
  its.write = write;
  its.due = false;
}

void DueTiles::on_written(std::uint64_t write, std::optional<std::uint64_t> file) {
  for (auto& [at, tile] : tiles_) {
    if (tile.write != write) continue;
    tile.write = 0;
    if (file) tile.file = *file;
    if (!file) tile.due = true;
  }
}

bool DueTiles::release_file(std::uint64_t file) {
  bool holds_any = false;
  for (auto& [at, tile] : tiles_) {
    if (tile.file != file) continue;
    tile.due = true;
    holds_any = true;
  }
  return !holds_any;
}

void DueTiles::begin(const picture::Mosaic& picture, const std::map<TileKey, std::uint64_t>& files) {
  tiles_.clear();
  seen_ = 0;
  mark_changed(picture);
  for (const auto& [tile, file] : files) tiles_[tile] = {.written = 1, .file = file};
}

namespace {

bool has(const std::vector<std::string>& all, const std::string& one) {
  return std::ranges::find(all, one) != all.end();
}

}  // namespace

void Samples::add(Sample sample) {
  if (!samples_.empty() && sample.at <= samples_.back().at) return;
  if (samples_.size() == kMost) thin();
  samples_.push_back(std::move(sample));
}

void Samples::add(api::AttentionStep step) {
  if (steps_.size() == kMostSteps) steps_.pop_front();
  steps_.push_back(std::move(step));
}

void Samples::move(double seconds) {
  for (Sample& sample : samples_) sample.at += seconds;
  for (api::AttentionStep& step : steps_) step.at += seconds;
}

void Samples::thin() {
  std::deque<Sample> kept;
  std::uint64_t throttled = 0;
  bool keep = false;
  for (Sample& sample : samples_) {
    throttled += sample.throttled;
    keep = !keep;
    if (!keep) continue;
    sample.throttled = std::exchange(throttled, 0);
    kept.push_back(std::move(sample));
  }
  kept.back().throttled += throttled;
  samples_ = std::move(kept);
  spacing_ *= 2;
}

api::History Samples::history_after(api::Time since) const {
  api::History all{.spacing = spacing_};
  const auto from = std::ranges::upper_bound(samples_, since, {}, &Sample::at);
  std::set<std::string> robots;
  for (auto sample = from; sample != samples_.end(); ++sample) {
    all.at.push_back(sample->at);
    all.sent_mbit.push_back(sample->sent_mbit);
    all.queued_bytes.push_back(sample->queued_bytes);
    all.scoring_ms.push_back(sample->scoring_ms);
    all.mapping_ms.push_back(sample->mapping_ms);
    all.throttled.push_back(sample->throttled);
    for (const auto& [robot, age] : sample->map_ages) robots.insert(robot);
  }
  for (const std::string& robot : robots) {
    api::MapAges& row = all.robots.emplace_back(robot);
    for (auto sample = from; sample != samples_.end(); ++sample) {
      const auto found = std::ranges::find(sample->map_ages, robot, &std::pair<std::string, double>::first);
      row.ages.push_back(found == sample->map_ages.end() ? std::nullopt : std::optional(found->second));
    }
  }
  for (const api::AttentionStep& step : steps_) {
    if (step.at > since) all.attention.push_back(step);
  }
  return all;
}

void Attention::restore(const std::vector<api::AttentionStep>& steps) {
  for (const api::AttentionStep& step : steps) {
    std::erase(shown_, step.sentence);
    if (step.came && shown_.size() < kMost) shown_.push_back(step.sentence);
  }
}

std::vector<api::AttentionStep> Attention::update(const std::vector<std::string>& sentences, api::Time now) {
  std::vector<api::AttentionStep> steps;
  std::vector<std::string> shown(
      sentences.begin(), sentences.begin() + static_cast<std::ptrdiff_t>(std::min(sentences.size(), kMost)));
  for (const std::string& sentence : shown_) {
    if (!has(shown, sentence)) steps.push_back({now, false, sentence});
  }
  for (const std::string& sentence : shown) {
    if (!has(shown_, sentence)) steps.push_back({now, true, sentence});
  }
  shown_ = std::move(shown);
  return steps;
}

void RunRecords::add_file(std::string_view bytes, std::uint64_t file) {
  damaged_ += for_each_record(bytes, [&](std::string_view record) {
    const auto known = read(record);
    if (known && (is_ours_ || std::holds_alternative<Head>(*known)))
      std::visit([&](const auto& one) { add(one, file); }, *known);
  });
}

/// A sample, or a need for attention.
template <class Line>
void RunRecords::add(const Line& line, std::uint64_t /*file*/) {
  last_line_ = std::max(last_line_, line.at);
  samples_.add(line);
}

/// Line and tile files are read separately, so each records every step. A failed write may repeat a step.
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

/// The first head identifies the run. Ignores other runs' files. A damaged head counts like the one before.
void RunRecords::add(const Head& head, std::uint64_t /*file*/) {
  if (!head_) head_ = head;
  is_ours_ = head_->run == head.run && head_->began == head.began;
  tiles_fit_ = head.tiles_fit();
}

void RunRecords::add(const TileState& state, std::uint64_t file) {
  const bool is_readable = !state.tile || packer_.is_whole(*state.tile);
  if (!tiles_fit_ || !is_readable || !picture_.restore(state.layer, state.at, state.tile, state.stamp))
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
