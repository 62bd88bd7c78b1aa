#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "dispatch/reports.hpp"
#include "forward/clocks.hpp"
#include "icd/scoring.hpp"
#include "ledger/ledger.hpp"

namespace adit::gateway {

/// Parsed answers to reports. Each is parsed once, because pages read hundreds several times a second.
class ReadAnswers {
 public:
  /// nullopt: no answer, or not to a report.
  const std::optional<icd::ReportReply>& answer_of(const dispatch::Report& report);

 private:
  static constexpr std::size_t kMost = 1000;  // entries
  struct CachedAnswer {
    std::string answer;
    std::optional<icd::ReportReply> reply;
  };
  std::map<std::int64_t, CachedAnswer> known_;  // by report number
};

/// For the page and `adit reports`.
facts::ReportRow row_of(const dispatch::Reports& reports, const dispatch::Report& report,
                        ReadAnswers& answers);
/// Reports above number `after`, oldest first.
std::vector<facts::ReportRow> rows_after(const dispatch::Reports& reports, std::int64_t after,
                                         std::size_t most);
api::ReportCounts counts_of(const dispatch::Reports& reports);
/// All unfinished reports, and the newest others if that makes no more than `most`; newest first.
std::vector<const dispatch::Report*> latest_of(const dispatch::ReportBook& book, std::size_t most);
std::vector<facts::ReportRow> latest_rows(const dispatch::Reports& reports, std::size_t most,
                                          ReadAnswers& answers);

void set_time_of_day(facts::ReportRow& row, const forward::Clocks& clocks);

/// nullopt: no such report.
std::optional<api::ReportDetail> detail_of(const dispatch::Reports& reports, const ledger::Ledger& ledger,
                                           std::int64_t number);

}  // namespace adit::gateway
