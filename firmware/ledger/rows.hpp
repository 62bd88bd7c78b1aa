#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dispatch/report.hpp"
#include "ledger/database.hpp"

namespace adit::ledger {

/// How reports, their steps and runs are written into their tables and read from them. What is bound must
/// outlive the query.

/// Inserts a report, or updates the same one under its number and adds to its history; changes no row where
/// the number is another's.
extern const char* const kWriteReport;
void bind_report(Query& query, const dispatch::Report& report, const std::string& history);

/// A history is a line for each step, "1763632493.25 7:sending 4:note": when, and each text after its length
/// in bytes, whatever is in it.
std::string history_of(std::span<const dispatch::Report> steps);
/// Nothing where that is no history.
std::optional<std::vector<Ledger::Step>> steps_of(std::int64_t number, std::string_view history);

extern const char* const kReadReports;
dispatch::Report report_of(const Query& row);

/// Of the report whose number is its one parameter.
extern const char* const kReadHistory;

/// Inserts a run, or updates the one of its number.
extern const char* const kWriteRun;
void bind_run(Query& query, const dispatch::Run& run);

extern const char* const kReadLastRun;
dispatch::Run run_of(const Query& row);

}  // namespace adit::ledger
