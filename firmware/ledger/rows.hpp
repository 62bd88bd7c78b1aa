#pragma once

#include "dispatch/report.hpp"
#include "ledger/database.hpp"

namespace adit::ledger {

/// How reports, steps and runs are written into their tables and read from them.

/// Inserts a report, or updates the same one under its number; changes no row where the number is another's.
extern const char* const kWriteReport;
void bind_report(Query& query, const dispatch::Report& report);

extern const char* const kReadReports;
dispatch::Report report_of(const Query& row);

extern const char* const kWriteStep;
void bind_step(Query& query, const dispatch::Report& report);

/// Of the report that is its one parameter.
extern const char* const kReadSteps;
Ledger::Step step_of(const Query& row);

/// Inserts a run, or updates the one of its number.
extern const char* const kWriteRun;
void bind_run(Query& query, const dispatch::Run& run);

extern const char* const kReadLastRun;
dispatch::Run run_of(const Query& row);

}  // namespace adit::ledger
