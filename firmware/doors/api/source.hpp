#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "api/scene.hpp"
#include "icd/scoring.hpp"
#include "icd/status.hpp"
#include "picture/coverage.hpp"
#include "picture/mosaic.hpp"

namespace adit::api {

/// The API's source of data.
class Source {
 public:
  virtual ~Source() = default;
  /// The present state. Not const: it records the alarms that it shows.
  virtual RunView view() = 0;
  /// Reports of all runs with a number above `after`, oldest first, at most `most`.
  virtual std::vector<facts::ReportRow> reports(std::int64_t after, std::size_t most) const = 0;
  virtual ReportCounts report_counts() const = 0;  // of all runs
  virtual std::optional<ReportDetail> report(std::int64_t number) const = 0;
  virtual const picture::Mosaic& map() const = 0;
  /// Changes after version `since`.
  virtual MarkerChanges markers(std::uint64_t since) const = 0;
  /// The robots' poses in this run after `since`.
  virtual std::vector<Track> tracks(Time since) const = 0;
};

/// The covered area of the present map, counted on request.
class CoveredMap {
 public:
  using Done = std::function<void(icd::Checked<picture::Coverage>)>;

  virtual ~CoveredMap() = default;
  /// Counts if the map has changed, then calls `done`, perhaps at once. Error: too many requests are queued.
  virtual void count(Done done) = 0;
};

/// Map levels finer than the mosaic's, for the present alone.
class FineMap {
 public:
  using Done = std::function<void(icd::Checked<picture::Tile>)>;

  virtual ~FineMap() = default;
  /// The existing tiles of a layer, and those changed after version `since`.
  virtual std::optional<picture::FinerLevels> finer_levels(const picture::Layer& layer,
                                                           std::uint64_t since) const = 0;
  /// Draws the tile if necessary, then calls `done`, perhaps at once. `at` must be in the world. Null: no
  /// finer data there. Error: too many requests are queued.
  virtual void tile(const picture::Layer& layer, const picture::TileIndex& at, Done done) = 0;
};

/// An operator's action on a report: see dispatch::Reports.
enum class Action : std::uint8_t { Send, Hold, Withdraw, Settle, Resubmit };

/// An operator's action on a rejected message.
enum class RejectedAction : std::uint8_t { Send, Discard };

/// Executes the operator's actions on reports, rejected messages and runs.
class Operator {
 public:
  virtual ~Operator() = default;
  /// Returns the number of the affected report. An error is a sentence.
  virtual std::expected<std::int64_t, std::string> decide(std::int64_t number, Action action) = 0;
  /// Accepts a report like a client's. Returns its number or an equal one's. An error is a sentence.
  virtual std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report,
                                                          bool resubmit) = 0;
  /// Sends `to` instead of a held report. Returns the number of the new report. An error is a sentence.
  virtual std::expected<std::int64_t, std::string> correct(std::int64_t number,
                                                           const icd::ArtifactReport& to) = 0;
  /// An error is a sentence.
  virtual std::expected<void, std::string> change_rejected(std::uint64_t number, RejectedAction action) = 0;
  /// Returns the new run's number.
  virtual std::int64_t begin_run() = 0;
};

/// Executes the operator's actions on the gateway itself.
class GatewayControl {
 public:
  virtual ~GatewayControl() = default;
  /// Silences an alarm until it gets worse or ends. An error is a sentence.
  virtual std::expected<void, std::string> acknowledge(const std::string& id) = 0;
  /// Replaces a ledger that cannot be read; the gateway restarts. Returns the new name of the old files.
  /// Error: 409 if it can be read, 503 if its files cannot be renamed.
  virtual icd::Checked<std::string> begin_ledger() = 0;
  /// Flashes all lights. Returns the end time.
  virtual Time identify(double seconds) = 0;
};

}  // namespace adit::api
