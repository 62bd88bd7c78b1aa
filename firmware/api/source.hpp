#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "api/scene.hpp"
#include "icd/artifact_report.hpp"
#include "icd/status.hpp"

namespace adit::picture {
class Mosaic;
}

namespace adit::api {

/// Where the API gets its answers.
class Source {
 public:
  virtual ~Source() = default;
  virtual RunView view() const = 0;
  /// Of all runs, those that are numbered above `after`, oldest first, at most `most`.
  virtual std::vector<ReportRow> reports(std::int64_t after, std::size_t most) const = 0;
  virtual ReportCounts report_counts() const = 0;  // of all runs
  virtual std::optional<ReportDetail> report(std::int64_t number) const = 0;
  virtual const picture::Mosaic& map() const = 0;
  /// What changed after version `since`.
  virtual MarkerChanges markers(std::uint64_t since) const = 0;
  /// Where each robot was in this run after `since`.
  virtual std::vector<Track> tracks(Time since) const = 0;
};

/// An operator's action on a report: see dispatch::Reports.
enum class Action : std::uint8_t { Send, Hold, Withdraw, Settle, Resubmit };

/// An operator's action on a message that was rejected.
enum class RejectedAction : std::uint8_t { Send, Discard };

/// What carries out the operator's actions.
class Operator {
 public:
  virtual ~Operator() = default;
  /// Gives the number of the report that it moved, or a sentence why not.
  virtual std::expected<std::int64_t, std::string> judge(std::int64_t number, Action action) = 0;
  /// Takes a report that the operator composed, like one that a client posts. Gives its number, or that of
  /// the same report if there is one already; a sentence: it was not taken.
  virtual std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report,
                                                          bool resubmit) = 0;
  /// A sentence: why not.
  virtual std::expected<void, std::string> rejected(std::uint64_t number, RejectedAction action) = 0;
  /// The alarm of that id is quiet until it gets worse or comes again. A sentence: why not.
  virtual std::expected<void, std::string> acknowledge(const std::string& id) = 0;
  /// Gives the new run's number.
  virtual std::int64_t begin_run() = 0;
  /// Instead of a ledger that cannot be read; the gateway restarts. Refused: 409 if it can be read, 503 if
  /// its files cannot be renamed. Gives their new name.
  virtual icd::Checked<std::string> begin_ledger() = 0;
  /// All lights blink for so long. Gives until when.
  virtual Time identify(double seconds) = 0;
};

}  // namespace adit::api
