#include "archive/write_queue.hpp"

#include <algorithm>
#include <utility>

#include "archive/record_kinds.hpp"
#include "archive/run_records.hpp"
#include "codec/row.hpp"

namespace adit::archive {

Poses::Poses(const std::vector<api::Track>& stored) {
  for (const api::Track& track : stored) last_ = std::max(last_, track.poses.back().at);
}

void Poses::add_to(Lines& lines, const std::vector<api::Track>& tracks, api::Time now) {
  for (const api::Track& track : tracks) {
    const bool is_news = has_moved(track);
    for (auto from = track.poses.begin(), end = track.poses.end(); from != end;) {
      const auto to = from + std::min<std::ptrdiff_t>(end - from, kLargestPoses);
      lines.add(record_of(api::Track{track.robot, {from, to}}), is_news);
      from = to;
    }
  }
  last_ = now;
}

/// The first pose of a robot counts as a move.
bool Poses::has_moved(const api::Track& track) {
  bool moves = false;
  for (const api::TrackPose& pose : track.poses) {
    const auto [last, is_new] = by_robot_.try_emplace(track.robot, pose);
    moves = moves || is_new || api::has_moved(last->second, pose);
    last->second = pose;
  }
  return moves;
}

void WriteQueue::begin() {
  lines_ = {};
  steps_.clear();
  make_due();
}

void WriteQueue::restore(RunRecords& stored, const std::vector<api::Track>& tracks,
                         const std::optional<double>& wiped, const picture::Mosaic& map) {
  wiped_ = wiped;
  poses_ = Poses(tracks);
  due_.begin(map, stored.files());
  layers_seen_ = map.version();
}

void WriteQueue::make_due() {
  next_facts_ = loop_.now();
  facts_.clear();
  lines_.make_due();
}

/// Keeps only as many lines as one write holds, so that the step goes with them.
void WriteQueue::move(double seconds) {
  poses_.move(seconds);
  if (wiped_) *wiped_ += seconds;
  facts_.clear();
  const Step step{seconds, std::chrono::duration<double>(loop_.now().time_since_epoch()).count()};
  lines_.add(record_of(step), true);
  lines_.trim_to(kLargestRecord);
  steps_ += record_of(step);
}

Sample WriteQueue::add(Sample sample) {
  const std::uint64_t before = std::exchange(throttled_, sample.throttled);
  sample.throttled -= std::min(before, sample.throttled);
  if (sample.map_ages.size() > kMostRobots) sample.map_ages.resize(kMostRobots);
  lines_.add(record_of(sample), false);
  return sample;
}

/// Lines go with any write, before tiles, because they are small and not replaced by newer ones.
std::shared_ptr<Write> WriteQueue::next(const RunSnapshot& seen, const api::RunRow& row, std::size_t most,
                                        double tiles_of) {
  auto write = std::make_shared<Write>();
  Batch& batch = write->batch;
  write->number = ++writes_;
  put_facts(row, batch);
  write->steps = std::exchange(steps_, "");
  batch.beside = write->steps;
  put_layers(seen.picture, batch);
  const std::size_t taken = batch.facts.size() + lines_.bytes() + batch.beside.size();
  put_tiles(seen, batch, most - std::min(most, taken), tiles_of);
  if (!batch.is_empty() || lines_.is_due(loop_.now())) batch.lines = lines_.pop(loop_.now());
  allowance_.spend(batch.lines.size());
  if (is_left_) write->goes = std::exchange(leaves_, std::nullopt);
  is_left_ = false;
  if (batch.is_empty() && !write->goes) return nullptr;
  return write;
}

void WriteQueue::put_facts(const api::RunRow& row, Batch& batch) {
  if (row.key.empty() || loop_.now() < next_facts_) return;
  next_facts_ = loop_.now() + kFactsEvery;
  api::RunRow facts = row;
  facts.last = 0;
  facts.stamp.reset();
  std::string text = codec::write_file(facts);
  if (text == facts_) return;
  facts_ = std::move(text);
  batch.facts = codec::write_file(row);
  allowance_.spend(batch.facts.size());
}

void WriteQueue::put_layers(const picture::Mosaic& picture, Batch& batch) {
  if (picture.wipe_time() && picture.wipe_time() != wiped_) {
    wiped_ = picture.wipe_time();
    batch.beside += record_of(WipeRecord{*wiped_});
  }
  if (picture.version() == layers_seen_) return;
  for (picture::LayerView& view : picture.layers(layers_seen_)) {
    if (view.version > layers_seen_ && view.bounds) batch.beside += record_of(std::move(view));
  }
  layers_seen_ = picture.version();
  allowance_.spend(batch.beside.size());
}

void WriteQueue::put_tiles(const RunSnapshot& seen, Batch& batch, std::size_t left, double tiles_of) {
  constexpr std::size_t kFraming = 200;  // most bytes of a record beside the tile, with a robot's name
  due_.mark_changed(seen.picture);
  for (const TileKey& key : due_.at(tiles_of)) {
    TileState state{.layer = key.first, .at = key.second, .stamp = 0, .tile = {}};
    const auto shown = seen.picture.tile(state.layer, state.at, std::nullopt);
    state.tile = shown.tile;
    state.stamp = shown.stamp;
    const std::size_t bytes = kFraming + (state.tile ? state.tile->deflated.size() : 0);
    if (bytes > left) return;
    due_.record_write(key, writes_, seen.stamp);
    left -= bytes;
    allowance_.spend(bytes);
    batch.tiles.push_back(std::move(state));
  }
}

void WriteQueue::on_written(const Write& write, std::uint64_t limit) {
  const auto& outcome = write.outcome;
  due_.on_written(write.number, outcome ? std::optional(outcome->file) : std::nullopt);
  if (!outcome) {
    make_due();
    steps_.insert(0, write.steps);
    layers_seen_ = 0;  // so that the next write has all layers
    wiped_.reset();
    lines_.give_back(write.batch.lines);
    return;
  }
  // Shortly before the limit, the newest tiles of the first file are written again. Then the file is removed.
  if (outcome->bytes > limit / 8 * 7 && outcome->first_file != 0) leaves_ = outcome->first_file;
  if (leaves_) is_left_ = due_.release_file(*leaves_);
}

}  // namespace adit::archive
