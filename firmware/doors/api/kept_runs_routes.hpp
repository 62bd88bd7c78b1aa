#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "api/route.hpp"
#include "api/source.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// Stored data of the present and earlier runs: README.md. A run is read once and held for kHeld after its
/// last use.
class KeptRunsRoutes {
 public:
  static constexpr std::chrono::seconds kHeld{60};
  static constexpr std::size_t kMostWaiting = 64;  // requests queued while a run is read

  /// All must outlive this object.
  KeptRunsRoutes(loop::Loop& loop, KeptRuns& runs, const Source& source);

  /// The plots of the present run.
  intake::Answer history(const intake::RequestHead& head) const;

  intake::Answer list() const;
  intake::Answer one(const Call& call) const;
  void layers(const Call& call);
  void tile(const Call& call);
  void tracks(const Call& call);
  void plots(const Call& call);
  /// The report for printing, as HTML.
  void report(const Call& call);
  void remove(const Call& call);

 private:
  using Answering = std::function<intake::Answer(const KeptRun& run)>;
  struct Waiting {
    std::shared_ptr<intake::Responder> responder;
    Answering answer;
  };
  struct Gathering;
  void with_run(const Call& call, Answering answer);
  void came(const std::string& key, const icd::Checked<std::shared_ptr<const KeptRun>>& run);
  void gather(const std::shared_ptr<Gathering>& gathering);
  const RunRow* row_of(const RunList& list, const std::string& key) const;

  loop::Loop& loop_;
  KeptRuns& runs_;
  const Source& source_;
  loop::Source forget_;
  std::shared_ptr<const KeptRun> held_;
  std::map<std::string, std::vector<Waiting>> waiting_;
};

}  // namespace adit::api
