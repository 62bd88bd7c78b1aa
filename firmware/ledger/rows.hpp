#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dispatch/report.hpp"
#include "dispatch/run.hpp"
#include "ledger/database.hpp"

namespace adit::ledger {

/// How reports, their steps and runs are written into their tables and read from them. What is bound must
/// outlive the query.

/// The columns of each table in their order, but for the proof, which is the last: integer, real, text or
/// blob. In capitals: it may be NULL. The first one is the row's number.
inline constexpr std::string_view kReportKinds = "itrrrtrrttiiiiirIRITitbit";
inline constexpr std::string_view kRunKinds = "itrtIRITrtt";
inline constexpr std::string_view kSightingKinds = "iiiRiRir";
inline constexpr std::string_view kRobotKinds = "it";
inline constexpr std::string_view kMarkKinds = "iiii";

/// Inserts a report, or updates the same one under its number and adds to its history; changes no row where
/// the number is another's.
extern const std::string kWriteReport;
void bind_report(Query& query, const dispatch::Report& report, const std::string& history);

/// Inserts the name of the robot that a report of that number was given, unless it is there.
extern const std::string kWriteRobot;
void bind_robot(Query& query, std::int64_t number, const icd::RobotName& robot);

/// A history is a line for each step, "1763632493.25 7:sending 4:note": when, and each text after its length
/// in bytes, whatever is in it.
std::string history_of(std::span<const dispatch::Report> steps);
/// Nothing where that is no history.
std::optional<std::vector<Ledger::Step>> steps_of(std::int64_t number, std::string_view history);

extern const std::string kReadReports;
dispatch::Report report_of(const Query& row);

/// Of the report whose number is its one parameter.
extern const std::string kReadHistory;

/// Inserts a run, or updates the one of its number.
extern const std::string kWriteRun;
void bind_run(Query& query, const dispatch::Run& run);
/// The same of what tells it from other runs, which is in a table of its own.
extern const std::string kWriteSighting;
void bind_sighting(Query& query, const dispatch::Run& run);

/// Gives a proof to the rows that an Adit wrote that knew none.
extern const std::string kProveRows;
/// The name of a row whose proof is another's, or that is not there ("report 7"), or "".
extern const std::string kUnprovenRow;

/// All runs, with what tells them from others.
extern const std::string kReadRuns;
dispatch::Run run_of(const Query& row);

}  // namespace adit::ledger
