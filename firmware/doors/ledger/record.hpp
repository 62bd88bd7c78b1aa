#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/value.hpp"
#include "dispatch/report.hpp"
#include "dispatch/runs.hpp"

namespace adit::ledger {

/// Kinds of records. The numbers are in files and must not change.
enum class Kind : std::uint8_t {
  Steps = 1,  // steps of reports and runs, written together
};

/// The bytes of a report or run. `more`: later members, written by a later version.
std::string encoded(const dispatch::Report& report, std::string_view more = {});
std::string encoded(const dispatch::Run& run, std::string_view more = {});
/// std::nullopt if a member is missing or the number is below 1. An unknown state becomes InDoubt, because
/// only the operator can decide on it.
std::optional<dispatch::Report> report_in(std::string_view record);
std::optional<dispatch::Run> run_in(std::string_view record);
/// For people and scripts.
codec::Value shown(const dispatch::Report& report);
codec::Value shown(const dispatch::Run& run);
/// The members that a later version wrote.
std::string_view more_of_report(std::string_view record);
std::string_view more_of_run(std::string_view record);

/// A step of a report. `state`: the API's word, or one unknown to this version.
struct Step {
  double at = 0;  // seconds since 1970
  std::string state, note;
  friend bool operator==(const Step&, const Step&) = default;
};
std::string encoded(const Step& step);
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
std::string encoded(const Steps& steps);
/// Parts of `record`, or std::nullopt if the record or a report or run in it is invalid.
std::optional<Steps> steps_record_in(std::string_view record);

}  // namespace adit::ledger
