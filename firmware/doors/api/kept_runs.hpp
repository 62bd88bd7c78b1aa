#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "api/scene.hpp"
#include "codec/row.hpp"
#include "icd/status.hpp"
#include "picture/mosaic.hpp"

namespace adit::api {

// Meaning and bounds of each member: descriptions in kept_runs.cpp.

/// Age of a robot's newest map at the Command Post, for each sample.
struct MapAges {
  std::string robot;
  std::vector<std::optional<double>> ages = {};

  static const codec::Row kRow;
};

/// Start or end of a need for attention.
struct AttentionStep {
  Time at = 0;
  bool came = false;
  std::string sentence;

  static const codec::Row kRow;
};

/// The plots of a run. Each list has one item for each sample, oldest first.
struct History {
  double spacing = 0;
  std::vector<Time> at = {};
  std::vector<double> sent_mbit = {};
  std::vector<std::uint64_t> queued_bytes = {};
  std::vector<std::optional<double>> scoring_ms = {}, mapping_ms = {};
  std::vector<std::uint64_t> throttled = {};
  std::vector<MapAges> robots = {};
  std::vector<AttentionStep> attention = {};

  static const codec::Row kRow;
};

/// A stored run and its last state.
struct RunRow {
  std::string key = "";  // its number, with a suffix if two runs share it
  std::int64_t run = 0;  // as in facts::ReportRow
  std::string id = "", course = "", post = "", team = "";
  Time began = 0, last = 0;
  std::optional<double> stamp = {};  // `last` by the stamp clock
  std::optional<std::int64_t> score = {}, remaining_reports = {};
  std::vector<std::string> robots = {};
  std::uint64_t bytes = 0;
  bool is_present = false;

  static const codec::Row kRow;
};

struct RunList {
  std::vector<RunRow> runs;  // the latest first
  std::uint64_t bytes = 0;
  std::string trouble;
  std::string unreadable = {};

  static const codec::Row kRow;
};

inline icd::Refusal no_such_run() {
  return {icd::Status::NotFound, "there is no such run"};
}

/// All stored data of a run.
struct KeptRun {
  RunRow facts;
  picture::Mosaic picture;
  std::vector<Track> tracks;
  History history;
  std::vector<ColourRow> colours = {};  // of the settings, not of the run's time
};

/// Stored runs: room archive.
class KeptRuns {
 public:
  virtual ~KeptRuns() = default;
  virtual RunList list() const = 0;
  /// The plots of the present run, after `since`.
  virtual History history(Time since) const = 0;
  /// Error: 404, no run has that key; 503, the run cannot be read.
  using ReadDone = std::function<void(icd::Checked<std::shared_ptr<const KeptRun>>)>;
  using ReportDone = std::function<void(icd::Checked<std::string>)>;
  /// Reads a run and calls `done` on the loop.
  virtual void read(const std::string& key, ReadDone done) = 0;
  /// The run's report for printing, as HTML. Calls `done` on the loop.
  virtual void report(const std::string& key, std::vector<ReportDetail> reports,
                      std::vector<ColourRow> colours, ReportDone done) = 0;
  /// Deletes a run, except the present one. Its reports stay in the ledger. Error: a sentence.
  virtual void remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) = 0;
};

}  // namespace adit::api
