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
#include "dispatch/run.hpp"

namespace adit::ledger {

/// What a record of the log says. The numbers are in files: they stay.
enum class Kind : std::uint8_t {
  Steps = 1,  // steps of reports and runs that were written at once
};

/// A report or run as a record has it, in bytes. `more`: members that a later version wrote behind ours.
std::string said(const dispatch::Report& report, std::string_view more = {});
std::string said(const dispatch::Run& run, std::string_view more = {});
/// Nothing if a member is missing or the number is below 1. A state that this version does not know is
/// InDoubt: only the operator can judge it.
std::optional<dispatch::Report> report_in(std::string_view said);
std::optional<dispatch::Run> run_in(std::string_view said);
/// For people and scripts.
codec::Value shown(const dispatch::Report& report);
codec::Value shown(const dispatch::Run& run);
/// Those members that a later version wrote.
std::string_view more_of_report(std::string_view said);
std::string_view more_of_run(std::string_view said);

/// One step of a report's life. `state` is the API's word, or a word that this version does not know.
struct Step {
  double at = 0;  // seconds since 1970
  std::string state, note;
  friend bool operator==(const Step&, const Step&) = default;
};
std::string said(const Step& step);
/// The step that made the report what it is.
std::string step_of(const dispatch::Report& report);
/// The steps whose bytes stand one behind the other; nothing if they do not.
std::optional<std::vector<Step>> steps_in(std::string_view said);

/// The content of a record of kind Steps.
struct Steps {
  struct Entry {
    std::string_view report;   // as it is after these steps
    std::string_view history;  // the steps
  };
  std::int64_t highest = 0;  // number of any report that was ever given out
  std::vector<Entry> reports;
  std::vector<std::string_view> runs;
};
std::string said(const Steps& steps);
/// Parts of `said`. Nothing if it is no such record, or one of its reports or runs is none.
std::optional<Steps> steps_record_in(std::string_view said);

}  // namespace adit::ledger
