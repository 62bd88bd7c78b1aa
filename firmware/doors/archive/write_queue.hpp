#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/allowance.hpp"
#include "archive/due_tiles.hpp"
#include "archive/lines.hpp"
#include "archive/poses.hpp"
#include "archive/run_folder.hpp"
#include "loop/loop.hpp"
#include "picture/mosaic.hpp"

namespace adit::archive {

/// State of the present run.
struct Seen {
  api::Time now = 0;
  double stamp = 0;  // `now` by the stamp clock
  const picture::Mosaic& picture;
  std::function<std::vector<api::Track>(api::Time since)> tracks;
  std::function<Sample()> sample;      // its `throttled` counts since the service started
  std::function<api::RunRow()> facts;  // `began` by the stamp clock; the archive sets key, end and bytes
};

/// One write. A thread executes it.
struct Write {
  std::uint64_t number = 0;
  Batch batch;
  std::string steps;                  // of the clock, in the batch
  std::optional<std::uint64_t> goes;  // file to remove
  std::expected<RunFolder::Written, std::string> outcome = std::unexpected("no memory");
};

/// The data of the present run that is not on disk. Decides which of it goes with the next write.
class WriteQueue {
 public:
  static constexpr std::chrono::seconds kFactsEvery{30};

  explicit WriteQueue(const loop::Loop& loop) : loop_(loop) {}

  /// A run begins.
  void begin();
  /// Its stored data was read. `map`: the one in use from now on.
  void go_on_from(RunRecords& stored, const std::vector<api::Track>& tracks,
                  const std::optional<double>& wiped, const picture::Mosaic& map);
  /// The next write has all lines and the facts.
  void be_due();
  /// Call if the time of day was advanced by `seconds`, before other functions use the new time.
  void move(double seconds);

  void add(std::string record, bool is_news) { lines_.add(std::move(record), is_news); }
  /// Queues a sample, and returns it with the 429s since the one before.
  Sample add(Sample sample);
  /// Queues the robots' poses since the last call. Call once for each `now`.
  void add_poses(const Seen& seen) { poses_.add_to(lines_, seen.tracks(poses_.last()), seen.now); }

  Allowance& allowance() { return allowance_; }
  /// The next write, or null if no data is due. `row`: the run's facts. `most`: bytes. `tiles_of`: the tiles
  /// that are due at that stamp.
  std::shared_ptr<Write> next(const Seen& seen, const api::RunRow& row, std::size_t most, double tiles_of);
  /// Call after the write. `limit`: of the run, in bytes.
  void done(const Write& write, std::uint64_t limit);

 private:
  void put_facts(const api::RunRow& row, Batch& batch);
  void put_layers(const picture::Mosaic& picture, Batch& batch);
  void put_tiles(const Seen& seen, Batch& batch, std::size_t left, double tiles_of);

  const loop::Loop& loop_;
  Allowance allowance_;
  DueTiles due_;
  Lines lines_;
  Poses poses_;
  std::uint64_t throttled_ = 0;    // last count
  std::uint64_t layers_seen_ = 0;  // Mosaic::version()
  std::optional<double> wiped_;    // as stored
  loop::Instant next_facts_{};
  std::string facts_;                    // as written last, without the time
  std::string steps_;                    // records of clock steps for the tile files
  std::optional<std::uint64_t> leaves_;  // the file to remove
  bool is_left_ = false;                 // it may be removed
  std::uint64_t writes_ = 0;
};

}  // namespace adit::archive
