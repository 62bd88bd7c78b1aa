#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/allowance.hpp"
#include "archive/due_tiles.hpp"
#include "archive/runs_folder.hpp"
#include "archive/samples.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "picture/mosaic.hpp"

namespace adit::archive {

/// What the disk may hold, in bytes.
struct Limits {
  std::uint64_t run = std::uint64_t{64} << 20;   // one run
  std::uint64_t all = std::uint64_t{512} << 20;  // all runs
};

/// How the present run stands.
struct Seen {
  api::Time now = 0;
  double stamp = 0;  // the same by the clock for stamps
  const picture::Mosaic& picture;
  std::function<std::vector<api::Track>(api::Time since)> tracks;
  std::function<Sample()> sample;  // its `throttled`: since the service started
  std::function<api::RunRow()>
      facts;  // `began` by the clock for stamps; key, end and bytes are the archive's
};

/// Keeps the runs' pictures, tracks and plots on the disk, so that they outlive a restart and a power cut:
/// README.md. The loop waits for none of it.
class Archive final : public api::KeptRuns {
 public:
  static constexpr std::chrono::seconds kWriteEvery{5}, kFactsEvery{30};
  /// Bytes of records that wait to be written, at most: a disk may be slow. Beyond it the oldest go.
  static constexpr std::size_t kMostWaiting = std::size_t{256} << 10;
  /// Of the picture of a run that is looked at again.
  static constexpr std::size_t kLookedAt = std::size_t{12} << 20;

  /// `loop` outlives this.
  Archive(loop::Loop& loop, const std::string& state_folder);
  ~Archive() override;

  void limit(const Limits& limits) { limits_ = limits; }

  /// From now on that run is the present one. What is kept of it comes once the disk has given it, whoever
  /// calls goes on with it, and gives the picture as it is then. Nothing is written before that.
  using GoOn = std::function<const picture::Mosaic&(picture::Mosaic picture, std::vector<api::Track> tracks)>;
  void begin(const Head& head, GoOn go_on);

  /// Once a second; writes what is due.
  void tick(const Seen& seen);
  /// Writes pending data at once, as far as the allowance permits. The process may end after it.
  void write_now(const Seen& seen);
  /// Writes all pending data of this run, beyond the allowance: it is the last chance. The facts are those of
  /// the last tick, because a newer status may be of the next run.
  void end_run(const Seen& seen);
  void needs_attention(const std::vector<std::string>& sentences, api::Time now);
  /// The time of day was set ahead by so many seconds: all that is kept of this run was as long ago as it
  /// was.
  void move(double seconds);

  /// Why nothing is written now; or "".
  const std::string& trouble() const { return trouble_; }
  /// The thread that writes, to be asked for signs of life.
  loop::Writer& thread() { return writer_; }

  api::RunList list() const override;
  api::History history(api::Time since) const override { return samples_.since(since); }
  void read(const std::string& key, std::function<void(std::shared_ptr<const api::KeptRun>)> done) override;
  void report(const std::string& key, std::vector<api::ReportDetail> reports,
              std::function<void(std::string html)> done) override;
  void remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) override;

 private:
  struct Opening;
  struct Writing;
  void opened(Opening& opening);
  void has_folder(const Opening& opening);
  /// Where the disk had no room for one.
  void make_folder();
  void line(const Said& said);
  void keep_lines_below(std::size_t most);
  void sample(const Seen& seen);
  void note(const Seen& seen);
  void note_poses(const Seen& seen);
  bool write(const Seen& seen, std::size_t most, api::Time tiles_of);
  void put_lines(Batch& batch);
  void put_facts(Batch& batch);
  void put_layers(const Seen& seen, Batch& batch);
  void put_tiles(const Seen& seen, Batch& batch, std::size_t left, api::Time tiles_of);
  void written(const Writing& writing);
  void look_at_disk();
  /// The present run's as it is now, which the disk has as of up to kFactsEvery ago; bytes as in `row`.
  std::function<bool()> enough() const;

  loop::Loop& loop_;
  RunsFolder runs_;
  Limits limits_;
  Allowance allowance_;
  DueTiles due_;
  Samples samples_;
  Attention attention_;
  std::deque<std::string> lines_;  // oldest first
  std::size_t lines_bytes_ = 0;
  std::uint64_t throttled_ = 0;    // as last told
  api::Time last_pose_ = 0;        // that is written, or is about to be
  std::uint64_t layers_seen_ = 0;  // Mosaic::version()
  std::optional<double> wiped_;    // as written
  loop::Instant next_write_{}, next_facts_{};
  api::RunRow row_;                      // the present run's as of the last tick, but for its bytes
  std::optional<std::uint64_t> leaves_;  // the file that is to go
  bool is_left_ = false;                 // it may
  std::uint64_t writes_ = 0;
  int writing_ = 0;  // writes under way
  bool opening_ = false;
  double moved_ = 0;         // meanwhile
  std::string steps_;        // records of the clock that was set, for the tiles
  std::uint64_t begun_ = 0;  // how often a run began here
  GoOn go_on_;
  Head head_;        // the present run's
  std::string key_;  // the present run's; "": not known yet
  std::shared_ptr<RunFolder> folder_;
  std::vector<api::RunRow> list_;
  std::string trouble_;
  std::shared_ptr<std::atomic<bool>> ending_ = std::make_shared<std::atomic<bool>>(false);
  loop::Writer writer_;  // last: its jobs end before all else
};

}  // namespace adit::archive
