#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "api/map_json.hpp"
#include "api/route.hpp"
#include "api/scene.hpp"
#include "api/source.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// The map, the markers and the robots' tracks: README.md.
class MapRoutes {
 public:
  /// All must outlive this object.
  MapRoutes(Source& source, FineMap& finer, CoveredMap& covered)
      : source_(source), finer_(finer), covered_(covered) {}

  icd::Checked<MapView> layers(const intake::RequestHead& head) const;
  void tile(const Call& call) const;
  void tiles(const Call& call) const;
  void covered(const Call& call) const;
  icd::Checked<MarkerChanges> markers(const intake::RequestHead& head) const;
  icd::Checked<Tracks> tracks(const intake::RequestHead& head) const;

 private:
  Source& source_;
  FineMap& finer_;
  CoveredMap& covered_;
};

/// Stored data of all runs: README.md. A run is read once and held for kHeld after its last use.
class KeptRunsRoutes {
 public:
  static constexpr std::chrono::seconds kHeld{60};
  static constexpr std::size_t kMostWaiting = 64;  // requests queued while a run is read

  /// All must outlive this object.
  KeptRunsRoutes(loop::Loop& loop, KeptRuns& runs, Source& source);

  /// The plots of the present run.
  icd::Checked<History> history(const intake::RequestHead& head) const;

  RunList list() const { return runs_.list(); }
  icd::Checked<RunRow> one(const Call& call) const { return row_of(call.parameters.front()); }
  void layers(const Call& call);
  void tile(const Call& call);
  void tiles(const Call& call);
  void tracks(const Call& call);
  void plots(const Call& call);
  /// The report for printing, as HTML.
  void report(const Call& call);
  void remove(const Call& call);

 private:
  using Answering = std::function<intake::Answer(const KeptRun& run)>;
  struct QueuedRequest {
    std::shared_ptr<intake::Responder> responder;
    Answering answer;
  };
  struct ReportCollector;
  void with_run(const Call& call, Answering answer);
  void on_run_read(const std::string& key, const icd::Checked<std::shared_ptr<const KeptRun>>& run);
  void collect_reports(const std::shared_ptr<ReportCollector>& gathering);
  /// Error: 404, or 503 if the list may lack a run.
  icd::Checked<RunRow> row_of(const std::string& key) const;

  loop::Loop& loop_;
  KeptRuns& runs_;
  Source& source_;
  loop::Source forget_;
  std::shared_ptr<const KeptRun> held_;
  std::map<std::string, std::vector<QueuedRequest>> waiting_;
};

}  // namespace adit::api
