#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/run_folder.hpp"
#include "archive/write_queue.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "picture/mosaic.hpp"

namespace adit::archive {

/// The runs on disk: lists, reads, reports and removes them on the writer's thread.
class StoredRuns {
 public:
  /// Most bytes of a stored run's map when it is shown again.
  static constexpr std::size_t kLookedAt = std::size_t{12} << 20;

  /// `writer` outlives this. Its pending completions must not run after this has ended.
  StoredRuns(loop::Writer& writer, RunsFolder folder);
  StoredRuns(const StoredRuns&) = delete;
  StoredRuns& operator=(const StoredRuns&) = delete;
  ~StoredRuns();

  const RunsFolder& folder() const { return folder_; }
  /// As of the last refresh().
  const RunsFolder::List& list() const { return list_; }
  /// Lists the directory again, on the thread. If that fails, list() keeps its runs and says why.
  void refresh();
  /// The run's size has changed. False: the run is not in list().
  bool resize(const std::string& key, std::uint64_t bytes);
  /// A function that returns true once this object ends.
  std::function<bool()> enough() const {
    return [ending = ending_] { return ending->load(); };
  }

  /// `present`: row of the present run.
  void read(const std::string& key, const api::RunRow& present, api::KeptRuns::ReadDone done);
  void report(const std::string& key, const api::RunRow& present, std::vector<api::ReportDetail> reports,
              std::vector<api::ColourRow> colours, api::KeptRuns::ReportDone done);
  void remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done);

 private:
  loop::Writer& writer_;
  RunsFolder folder_;
  RunsFolder::List list_;
  std::shared_ptr<std::atomic<bool>> ending_ = std::make_shared<std::atomic<bool>>(false);
};

/// Space limits on disk, in bytes.
struct Limits {
  std::uint64_t run = std::uint64_t{64} << 20;   // for one run
  std::uint64_t all = std::uint64_t{512} << 20;  // for all runs
};

/// Stores the runs' maps, tracks and plots on disk across restarts and power cuts: README.md. A thread
/// writes; the loop never blocks.
class Archive final : public api::KeptRuns {
 public:
  static constexpr std::chrono::seconds kWriteEvery{5};

  /// `loop` must outlive this object.
  Archive(loop::Loop& loop, const std::string& state_folder);

  void limit(const Limits& limits) { limits_ = limits; }

  /// Makes a run the present one. After its stored data was read, calls `go_on` with the data, and expects
  /// the map that is in use from then on. Writes only after that.
  using GoOn = std::function<const picture::Mosaic&(picture::Mosaic picture, std::vector<api::Track> tracks)>;
  void begin(const Head& head, GoOn go_on);

  /// Call once a second. Writes due data.
  void tick(const RunSnapshot& seen);
  /// Writes queued data at once, within the allowance. The process may end afterwards.
  void write_now(const RunSnapshot& seen);
  /// Writes all queued data of this run, beyond the allowance, because it is the last chance. Stores the
  /// facts of the last tick, because a newer status may belong to the next run.
  void end_run(const RunSnapshot& seen);
  void set_attention(const std::vector<std::string>& sentences, api::Time now);
  /// Call if the time of day was advanced by `seconds`: shifts all times of this run.
  void move(double seconds);

  /// Why the run is not stored, or "".
  const std::string& trouble() const { return trouble_; }
  /// The writing thread, for the watchdog.
  loop::Writer& thread() { return writer_; }

  api::RunList list() const override;
  api::History history(api::Time since) const override { return samples_.history_after(since); }
  void read(const std::string& key, ReadDone done) override {
    stored_.read(key, present_.row, std::move(done));
  }
  void report(const std::string& key, std::vector<api::ReportDetail> reports,
              std::vector<api::ColourRow> colours, ReportDone done) override {
    stored_.report(key, present_.row, std::move(reports), std::move(colours), std::move(done));
  }
  void remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) override;

 private:
  struct OpenedRun;
  struct PendingRead {
    GoOn go_on;
    double moved = 0;  // clock steps meanwhile, in seconds
  };
  /// The run that is recorded.
  struct PresentRun {
    Head head;
    std::string key;                    // "": not known yet
    std::shared_ptr<RunFolder> folder;  // null: it has no directory
    api::RunRow row;                    // at the last tick, without its bytes
  };

  void on_opened(OpenedRun& opening);
  void on_folder_open(const OpenedRun& opening);
  /// Retries if the run has no directory.
  void make_folder();
  void note(const RunSnapshot& seen);
  bool write(const RunSnapshot& seen, std::size_t most, double tiles_of);
  void on_written(const Write& write);

  loop::Loop& loop_;
  Limits limits_;
  WriteQueue queue_;
  Samples samples_;
  Attention attention_;
  PresentRun present_;
  std::optional<PendingRead> begun_;
  std::uint64_t begins_ = 0;  // number of begin() calls
  loop::Instant next_write_{};
  int writing_ = 0;  // writes in flight
  std::string trouble_;
  loop::Writer writer_;  // after what its jobs use
  StoredRuns stored_;    // ends first, because it tells the jobs to end early
};

}  // namespace adit::archive
