#pragma once

#include <cstdint>
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
#include "archive/samples.hpp"
#include "archive/stored_runs.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "picture/mosaic.hpp"

namespace adit::archive {

/// Space limits on disk, in bytes.
struct Limits {
  std::uint64_t run = std::uint64_t{64} << 20;   // for one run
  std::uint64_t all = std::uint64_t{512} << 20;  // for all runs
};

/// State of the present run.
struct Seen {
  api::Time now = 0;
  double stamp = 0;  // `now` by the stamp clock
  const picture::Mosaic& picture;
  std::function<std::vector<api::Track>(api::Time since)> tracks;
  std::function<Sample()> sample;      // its `throttled` counts since the service started
  std::function<api::RunRow()> facts;  // `began` by the stamp clock; the archive sets key, end and bytes
};

/// Stores the runs' maps, tracks and plots on disk across restarts and power cuts: README.md. A thread
/// writes; the loop never blocks.
class Archive final : public api::KeptRuns {
 public:
  static constexpr std::chrono::seconds kWriteEvery{5}, kFactsEvery{30};

  /// `loop` must outlive this object.
  Archive(loop::Loop& loop, const std::string& state_folder);

  void limit(const Limits& limits) { limits_ = limits; }

  /// Makes a run the present one. After its stored data was read, calls `go_on` with the data, and expects
  /// the map that is in use from then on. Writes only after that.
  using GoOn = std::function<const picture::Mosaic&(picture::Mosaic picture, std::vector<api::Track> tracks)>;
  void begin(const Head& head, GoOn go_on);

  /// Call once a second. Writes due data.
  void tick(const Seen& seen);
  /// Writes queued data at once, within the allowance. The process may end afterwards.
  void write_now(const Seen& seen);
  /// Writes all queued data of this run, beyond the allowance, because it is the last chance. Stores the
  /// facts of the last tick, because a newer status may belong to the next run.
  void end_run(const Seen& seen);
  void needs_attention(const std::vector<std::string>& sentences, api::Time now);
  /// Call if the time of day was advanced by `seconds`: shifts all times of this run.
  void move(double seconds);

  /// Why the run is not stored, or "".
  const std::string& trouble() const { return trouble_; }
  /// The writing thread, for the watchdog.
  loop::Writer& thread() { return writer_; }

  api::RunList list() const override;
  api::History history(api::Time since) const override { return samples_.since(since); }
  void read(const std::string& key, ReadDone done) override { stored_.read(key, row_, std::move(done)); }
  void report(const std::string& key, std::vector<api::ReportDetail> reports,
              std::vector<api::ColourRow> colours, ReportDone done) override {
    stored_.report(key, row_, std::move(reports), std::move(colours), std::move(done));
  }
  void remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) override;

 private:
  struct Opening;
  struct Writing;
  void opened(Opening& opening);
  void has_folder(const Opening& opening);
  /// Retries if the run has no directory.
  void make_folder();
  /// The next write has all.
  void be_due();
  void sample(const Seen& seen);
  void note(const Seen& seen);
  bool write(const Seen& seen, std::size_t most, api::Time tiles_of);
  void put_facts(Batch& batch);
  void put_layers(const Seen& seen, Batch& batch);
  void put_tiles(const Seen& seen, Batch& batch, std::size_t left, api::Time tiles_of);
  void written(const Writing& writing);

  loop::Loop& loop_;
  Limits limits_;
  Allowance allowance_;
  DueTiles due_;
  Samples samples_;
  Attention attention_;
  Lines lines_;
  Poses poses_;
  std::uint64_t throttled_ = 0;    // last count
  std::uint64_t layers_seen_ = 0;  // Mosaic::version()
  std::optional<double> wiped_;    // as stored
  loop::Instant next_write_{}, next_facts_{};
  api::RunRow row_;                      // the present run at the last tick, without its bytes
  std::string facts_;                    // as written last, without the time
  std::optional<std::uint64_t> leaves_;  // the file to remove
  bool is_left_ = false;                 // it may be removed
  std::uint64_t writes_ = 0;
  int writing_ = 0;  // writes in flight
  bool opening_ = false;
  double moved_ = 0;         // clock steps during the opening, in seconds
  std::string steps_;        // records of clock steps for the tile files
  std::uint64_t begun_ = 0;  // number of begin() calls
  GoOn go_on_;
  Head head_;        // of the present run
  std::string key_;  // of the present run; "": not known yet
  std::shared_ptr<RunFolder> folder_;
  std::string trouble_;
  loop::Writer writer_;  // after what its jobs use
  StoredRuns stored_;    // ends first, because it tells the jobs to end early
};

}  // namespace adit::archive
