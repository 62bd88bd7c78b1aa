#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/run_records.hpp"
#include "archive/runs_folder.hpp"
#include "loop/workers.hpp"

namespace adit::archive {

/// Reads a run. Skips unreadable files and damaged records, and reports them in the log and in the run's own
/// list of attention. Blocks on the disk until all is read or `enough` returns true.
void read_all(const RunsFolder& runs, const std::string& key, RunRecords& told,
              const std::function<bool()>& enough);

/// The present run's row as it is now, others as on disk. Converts the start from the stamp clock, which the
/// ledger uses, to the time of day, like the end.
api::RunRow with_times(const api::RunRow& row, const api::RunRow& present);

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
  /// As of the last look().
  const RunsFolder::List& list() const { return list_; }
  /// Lists the directory again, on the thread. If that fails, list() keeps its runs and says why.
  void look();
  /// The run's size has changed. False: the run is not in list().
  bool resize(const std::string& key, std::uint64_t bytes);
  /// A function that returns true once this object ends.
  std::function<bool()> enough() const;

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

}  // namespace adit::archive
