#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "dispatch/reports.hpp"
#include "icd/run_status.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"

namespace adit::gateway {

/// What the Command Post's answers to reports say. Each is read once, for as long as it is the same: a page
/// looks at hundreds of them several times a second.
class ReadAnswers {
 public:
  /// Nothing: there is none, or it is no answer to a report.
  const std::optional<icd::ReportReply>& of(const dispatch::Report& report);

 private:
  static constexpr std::size_t kMost = 1000;  // are known at once
  struct Known {
    std::string answer;
    std::optional<icd::ReportReply> reply;
  };
  std::map<std::int64_t, Known> known_;  // by the report's number
};

/// Reports as the page and `adit reports` show them.
api::ReportRow row_of(const dispatch::Reports& reports, const dispatch::Report& report, ReadAnswers& answers);
/// Those that are numbered above `after`, oldest first, at most `most`.
std::vector<api::ReportRow> rows_after(const dispatch::Reports& reports, std::int64_t after,
                                       std::size_t most);
api::ReportCounts counts_of(const dispatch::Reports& reports);
/// At most `most` of them, newest first: those with which something is still to happen, and the newest
/// others.
std::vector<const dispatch::Report*> latest_of(const dispatch::ReportBook& book, std::size_t most);
std::vector<api::ReportRow> latest_rows(const dispatch::Reports& reports, std::size_t most,
                                        ReadAnswers& answers);

/// Of a time in the ledger, which is by the clock for stamps, the time of day as it is set now; one of an
/// earlier start of the machine is as it was written.
double time_of_day(double at, const loop::Loop& loop);
void tell_time_of_day(api::ReportRow& row, const loop::Loop& loop);

/// One report with its history, or nothing where there is none of that number.
std::optional<api::ReportDetail> detail_of(const dispatch::Reports& reports, const ledger::Ledger& ledger,
                                           std::int64_t number);

}  // namespace adit::gateway
