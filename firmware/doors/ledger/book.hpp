#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/value.hpp"
#include "dispatch/merged_reports.hpp"
#include "dispatch/report.hpp"
#include "dispatch/runs.hpp"
#include "store/contents.hpp"
#include "store/directory.hpp"

namespace adit::ledger {

/// Kinds of records. The numbers are in files and must not change.
enum class RecordKind : std::uint8_t {
  Steps = 1,  // steps of reports and runs, written together
};

/// The bytes of a report or run. `more`: later members, written by a later version.
std::string to_bytes(const dispatch::Report& report, std::string_view more = {});
std::string to_bytes(const dispatch::Run& run, std::string_view more = {});
/// std::nullopt: a member is missing or the number below 1. An unknown state is InDoubt, for the operator.
std::optional<dispatch::Report> report_in(std::string_view record);
std::optional<dispatch::Run> run_in(std::string_view record);
/// For people and scripts.
codec::Value to_value(const dispatch::Report& report);
codec::Value to_value(const dispatch::Run& run);
/// The members that a later version wrote.
std::string_view more_of_report(std::string_view record);
std::string_view more_of_run(std::string_view record);

/// A step of a report. `state`: the API's word, or one unknown to this version.
struct Step {
  double at = 0;  // seconds since 1970
  std::string state, note;
  friend bool operator==(const Step&, const Step&) = default;
};
std::string to_bytes(const Step& step);
/// The step to the report's present state.
std::string step_of(const dispatch::Report& report);
/// The steps in these bytes, or std::nullopt if they are invalid.
std::optional<std::vector<Step>> steps_in(std::string_view record);

/// The body of a record of kind Steps.
struct Steps {
  struct Entry {
    std::string_view report;   // after these steps
    std::string_view history;  // the steps
  };
  std::int64_t highest = 0;  // highest number ever given out
  std::vector<Entry> reports;
  std::vector<std::string_view> runs;
};
std::string to_bytes(const Steps& steps);
/// Parts of `record`, or std::nullopt if the record or a report or run in it is invalid.
std::optional<Steps> steps_record_in(std::string_view record);

/// The sum of a ledger's records: each report's last state with all its steps, and each run.
class Book {
 public:
  struct StoredReport {
    std::string record, history;  // as in records (Steps)
  };

  /// False: the record is invalid and has no effect.
  bool apply(std::uint8_t kind, std::string_view body);
  /// The same content as few records.
  std::vector<std::pair<std::uint8_t, std::string>> records() const;
  /// All reports and runs as the body of one record.
  std::string copy() const { return record_of(reports_, runs_); }

  /// The record of these steps. Error: a step would replace another report, or a value is not a number.
  store::Result<std::string> record(std::span<const dispatch::Report> steps, const dispatch::Run* run) const;
  /// The record of a takeover from `there`.
  store::Result<std::string> record(const dispatch::TakeoverChanges& taken, const Book& there) const;
  bool knows(std::int64_t report) const { return reports_.contains(report); }

  std::vector<dispatch::Report> reports() const;  // oldest first
  std::vector<dispatch::Run> runs() const;        // oldest first
  std::vector<Step> history(std::int64_t number) const;
  std::int64_t highest() const { return highest_; }

  /// Repairs a log with missing records: each unfinished report becomes in doubt, and a report stands for
  /// each missing number. `expected`: least count of numbers given out. `end_is_lost`: the number of the last
  /// reports is unknown. Returns a sentence about the reports read and lost.
  std::string salvage(double now, std::int64_t expected, bool end_is_lost);

 private:
  using Reports = std::map<std::int64_t, StoredReport>;
  using Runs = std::map<std::int64_t, std::string>;
  /// One record of these reports and runs.
  std::string record_of(const Reports& reports, const Runs& runs) const;
  /// With members of a later version that the run has here.
  std::string encode_with_unknown(const dispatch::Run& run) const;
  double last_heard() const;
  void put(const dispatch::Report& report);
  void add_lost(std::int64_t last, const std::string& note, double now);

  Reports reports_;
  Runs runs_;
  std::int64_t highest_ = 0;
  std::vector<std::pair<std::uint8_t, std::string>> unknown_;  // records of a later version
};

/// The content of a log.
struct ReadResult {
  Book book;
  std::string gap = "";      // a sentence about missing records, or ""
  bool end_is_lost = false;  // the last records are missing
};
/// Error: a later version wrote a record that this one must understand.
store::Result<ReadResult> read(const store::Contents& contents);

}  // namespace adit::ledger
