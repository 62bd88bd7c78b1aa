// Decides which data of the present run is written, and when.
#include <algorithm>
#include <limits>
#include <utility>

#include "archive/archive.hpp"
#include "codec/row_file.hpp"
#include "host/log.hpp"

namespace adit::archive {
namespace {

/// Makes every changed tile due.
constexpr api::Time kNoneRests = std::numeric_limits<api::Time>::infinity();

}  // namespace

/// One write, executed by the thread.
struct Archive::Writing {
  std::uint64_t number = 0, begun = 0;
  Batch batch;
  std::string steps;  // in the batch
  std::shared_ptr<RunFolder> folder;
  std::uint64_t most = 0;
  std::optional<std::uint64_t> goes;  // file to remove
  std::expected<RunFolder::Written, std::string> outcome = std::unexpected("no memory");
};

void Archive::tick(const Seen& seen) {
  if (opening_) return;
  sample(seen);
  note(seen);
  if (writing_ > 0 || loop_.now() < next_write_) return;
  if (folder_) {
    poses_.add_to(lines_, seen.tracks(poses_.last()), seen.now);
    write(seen, allowance_.at(loop_.now()), seen.now);
  } else if (!trouble_.empty()) {
    make_folder();
  }
}

void Archive::write_now(const Seen& seen) {
  if (opening_ || !folder_) return;
  note(seen);
  poses_.add_to(lines_, seen.tracks(poses_.last()), seen.now);
  be_due();
  write(seen, allowance_.at(loop_.now()), kNoneRests);
}

void Archive::end_run(const Seen& seen) {
  if (opening_ || !folder_) return;
  poses_.add_to(lines_, seen.tracks(poses_.last()), seen.now);
  be_due();
  const Allowance of_the_next = allowance_;
  while (write(seen, static_cast<std::size_t>(Allowance::kMost), kNoneRests)) {
  }
  allowance_ = of_the_next;
}

void Archive::note(const Seen& seen) {
  row_ = seen.facts();
  row_.key = key_;
  row_.last = seen.now;
  row_.stamp = seen.stamp;
}

void Archive::sample(const Seen& seen) {
  if (!samples_.wants(seen.now)) return;
  Sample now = seen.sample();
  const std::uint64_t throttled = std::exchange(throttled_, now.throttled);
  now.throttled -= std::min(throttled, now.throttled);
  if (now.map_ages.size() > kMostRobots) now.map_ages.resize(kMostRobots);
  lines_.add(record_of(now), false);
  samples_.add(std::move(now));
}

/// Tiles: those due at `tiles_of`. Lines go with any write, and have room before tiles, because they are
/// small and not replaced by newer ones. False: no data was due.
bool Archive::write(const Seen& seen, std::size_t most, api::Time tiles_of) {
  next_write_ = loop_.now() + kWriteEvery;
  const auto writing = std::make_shared<Writing>();
  Batch& batch = writing->batch;
  writing->number = ++writes_;
  writing->begun = begun_;
  put_facts(batch);
  writing->steps = std::exchange(steps_, "");
  batch.beside = writing->steps;
  put_layers(seen, batch);
  const std::size_t taken = batch.facts.size() + lines_.bytes() + batch.beside.size();
  put_tiles(seen, batch, most - std::min(most, taken), tiles_of);
  if (!batch.is_empty() || lines_.is_due(loop_.now())) batch.lines = lines_.take(loop_.now());
  allowance_.spend(batch.lines.size());
  if (is_left_) writing->goes = std::exchange(leaves_, std::nullopt);
  is_left_ = false;
  if (batch.is_empty() && !writing->goes) return false;
  writing->folder = folder_;
  writing->most = limits_.run;
  ++writing_;
  writer_.submit(
      [writing] {
        if (writing->goes) writing->folder->remove_first(*writing->goes);
        writing->outcome = writing->folder->write(writing->batch, writing->most);
      },
      [this, writing] { written(*writing); });
  return true;
}

void Archive::put_facts(Batch& batch) {
  if (row_.key.empty() || loop_.now() < next_facts_) return;
  next_facts_ = loop_.now() + kFactsEvery;
  api::RunRow facts = row_;
  facts.last = 0;
  facts.stamp.reset();
  std::string text = codec::write_file(facts);
  if (text == facts_) return;
  facts_ = std::move(text);
  batch.facts = codec::write_file(row_);
  allowance_.spend(batch.facts.size());
}

void Archive::put_layers(const Seen& seen, Batch& batch) {
  const picture::Mosaic& picture = seen.picture;
  if (picture.wiped() && picture.wiped() != wiped_) {
    wiped_ = picture.wiped();
    batch.beside += record_of(Wiped{*wiped_});
  }
  if (picture.version() == layers_seen_) return;
  for (picture::LayerView& view : picture.layers(layers_seen_)) {
    if (view.version > layers_seen_ && view.bounds) batch.beside += record_of(std::move(view));
  }
  layers_seen_ = picture.version();
  allowance_.spend(batch.beside.size());
}

void Archive::put_tiles(const Seen& seen, Batch& batch, std::size_t left, api::Time tiles_of) {
  constexpr std::size_t kFraming = 200;  // most bytes of a record beside the tile, with a robot's name
  due_.look(seen.picture);
  for (const TileKey& key : due_.at(tiles_of)) {
    TileState state{.layer = key.first, .at = key.second, .stamp = 0, .tile = {}};
    const auto shown = seen.picture.tile(state.layer, state.at, std::nullopt);
    state.tile = shown.tile;
    state.stamp = shown.stamp;
    const std::size_t bytes = kFraming + (state.tile ? state.tile->deflated.size() : 0);
    if (bytes > left) return;
    due_.being_written(key, writes_, seen.now);
    left -= bytes;
    allowance_.spend(bytes);
    batch.tiles.push_back(std::move(state));
  }
}

void Archive::written(const Writing& writing) {
  --writing_;
  const auto& outcome = writing.outcome;
  const std::string why = outcome ? "" : outcome.error();
  if (writing.begun != begun_) {
    if (!why.empty())
      host::log(host::Level::Warning, "cannot store the end of the previous run", {{"why", why}});
    return;
  }
  due_.done(writing.number, outcome ? std::optional(outcome->file) : std::nullopt);
  if (std::exchange(trouble_, why) != why && !why.empty())
    host::log(host::Level::Warning, "cannot store the run's map and tracks", {{"why", why}});
  if (!outcome) {
    be_due();
    steps_.insert(0, writing.steps);
    layers_seen_ = 0;  // so that the next write has all layers
    wiped_.reset();
    lines_.give_back(writing.batch.lines);
    return;
  }
  if (!stored_.resize(key_, outcome->bytes)) stored_.look();
  // Shortly before the limit, the newest tiles of the first file are written again. Then the file is removed.
  if (outcome->bytes > limits_.run / 8 * 7 && outcome->first_file != 0) leaves_ = outcome->first_file;
  if (leaves_) is_left_ = due_.leave(*leaves_);
}

}  // namespace adit::archive
