#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/record_kinds.hpp"
#include "archive/run_folder.hpp"
#include "archive/run_records.hpp"
#include "loop/loop.hpp"
#include "picture/mosaic.hpp"

namespace adit::archive {

/// Limits writes to less than 1 MB in any minute, over all files. The unused part may grow to one record, so
/// that every record can be written, and no write is larger.
class Allowance {
 public:
  static constexpr double kASecond = 14000;  // bytes per second
  static constexpr double kMost = kLargestRecord + 1024;

  /// Bytes that may be written at `now`, which must not run back.
  std::size_t at(loop::Instant now) {
    if (last_ == loop::Instant{}) last_ = now;
    const double passed = std::chrono::duration<double>(now - last_).count();
    left_ = std::min(kMost, left_ + passed * kASecond);
    last_ = now;
    return static_cast<std::size_t>(std::max(left_, 0.0));
  }
  /// Records a write, done or planned.
  void spend(std::size_t bytes) { left_ -= static_cast<double>(bytes); }

 private:
  double left_ = kMost;
  loop::Instant last_{};
};

/// Which poses of the robots are stored or queued.
class Poses {
 public:
  Poses() = default;
  /// `stored`: from before a restart.
  explicit Poses(const std::vector<api::Track>& stored);

  /// Time of the newest stored or queued pose.
  api::Time last() const { return last_; }
  /// Queues poses since last(). Call once for each `now`: if the time of day was set back, a second call
  /// would store the same poses again.
  void add_to(Lines& lines, const std::vector<api::Track>& tracks, api::Time now);
  /// Call if the time of day was advanced by `seconds`.
  void move(double seconds) { last_ += seconds; }

 private:
  bool has_moved(const api::Track& track);

  api::Time last_ = 0;
  std::map<std::string, api::TrackPose> by_robot_;  // last added
};

struct RunSnapshot {
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
  std::expected<RunFolder::WriteResult, std::string> outcome = std::unexpected("no memory");
};

/// The data of the present run that is not on disk. Decides which of it goes with the next write.
class WriteQueue {
 public:
  static constexpr std::chrono::seconds kFactsEvery{30};

  explicit WriteQueue(const loop::Loop& loop) : loop_(loop) {}

  /// A run begins.
  void begin();
  /// Its stored data was read. `map`: the one in use from now on.
  void restore(RunRecords& stored, const std::vector<api::Track>& tracks, const std::optional<double>& wiped,
               const picture::Mosaic& map);
  /// The next write has all lines and the facts.
  void make_due();
  /// Call if the time of day was advanced by `seconds`, before other functions use the new time.
  void move(double seconds);

  void add(std::string record, bool is_news) { lines_.add(std::move(record), is_news); }
  /// Queues a sample, and returns it with the 429s since the one before.
  Sample add(Sample sample);
  /// Queues the robots' poses since the last call. Call once for each `now`.
  void add_poses(const RunSnapshot& seen) { poses_.add_to(lines_, seen.tracks(poses_.last()), seen.now); }

  Allowance& allowance() { return allowance_; }
  /// The next write, or null if no data is due. `row`: the run's facts. `most`: bytes. `tiles_of`: the tiles
  /// that are due at that stamp.
  std::shared_ptr<Write> next(const RunSnapshot& seen, const api::RunRow& row, std::size_t most,
                              double tiles_of);
  /// Call after the write. `limit`: of the run, in bytes.
  void on_written(const Write& write, std::uint64_t limit);

 private:
  void put_facts(const api::RunRow& row, Batch& batch);
  void put_layers(const picture::Mosaic& picture, Batch& batch);
  void put_tiles(const RunSnapshot& seen, Batch& batch, std::size_t left, double tiles_of);

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
