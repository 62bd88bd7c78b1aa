#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/run_view.hpp"
#include "api/scene.hpp"
#include "codec/row.hpp"
#include "picture/mosaic.hpp"

namespace adit::api {

// What each member says, and its bounds, is in the descriptions: kept_runs.cpp.

/// How old the newest map is that the Command Post has of a robot, at each sample.
struct MapAges {
  std::string robot;
  std::vector<std::optional<double>> ages = {};

  static const codec::Row kRow;
};

/// Something that needed the operator: it came, or it went.
struct AttentionStep {
  Time at = 0;
  bool came = false;
  std::string sentence;

  static const codec::Row kRow;
};

/// The plots of a run. Each list has an item for each sample, oldest first.
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

/// A run that is kept: which it was, and how it stood at last.
struct RunRow {
  std::string key = "";  // what it is asked for by: its number, and more where two runs have the same
  std::int64_t run = 0;  // as in ReportRow
  std::string id = "", course = "", post = "", team = "";
  Time began = 0, last = 0;
  std::optional<double> stamp = {};  // `last`, by the clock for stamps
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

  static const codec::Row kRow;
};

/// All that is kept of a run.
struct KeptRun {
  RunRow facts;
  picture::Mosaic picture;
  std::vector<Track> tracks;
  History history;
  std::vector<std::pair<Time, double>> coverage = {};  // m2 that were known of all layers, over time
};

/// The runs that outlive a restart: room archive.
class KeptRuns {
 public:
  virtual ~KeptRuns() = default;
  virtual RunList list() const = 0;
  /// The plots of the present run, after `since`.
  virtual History history(Time since) const = 0;
  /// Reads a run, and calls `done` on the loop: null where there is none of that key, or it is gone.
  virtual void read(const std::string& key, std::function<void(std::shared_ptr<const KeptRun>)> done) = 0;
  /// Its report to print: HTML; "" where there is none of that key, or it is gone.
  virtual void report(const std::string& key, std::vector<ReportDetail> reports,
                      std::function<void(std::string html)> done) = 0;
  /// Forgets it: never the present one. A sentence: why not. Its reports stay in the ledger.
  virtual void remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) = 0;
};

}  // namespace adit::api
