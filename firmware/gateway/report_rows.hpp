#pragma once

#include <map>
#include <vector>

#include "dispatch/reports.hpp"
#include "ledger/ledger.hpp"
#include "page/page.hpp"

namespace adit::gateway {

/// Reports as the page and `adit reports` show them.
page::ReportRow row_of(const dispatch::Reports& reports, const dispatch::Report& report);
/// All of them, oldest first.
std::vector<page::ReportRow> all_rows(const dispatch::Reports& reports);
/// At most `most` of them, newest first: those with which something is still to happen, and the newest
/// others.
std::vector<const dispatch::Report*> latest_of(const std::map<std::int64_t, dispatch::Report>& all,
                                               std::size_t most);
std::vector<page::ReportRow> latest_rows(const dispatch::Reports& reports, std::size_t most);

/// One report with its history, or nothing where there is none of that number.
std::optional<page::ReportDetail> detail_of(const dispatch::Reports& reports, const ledger::Ledger& ledger,
                                            std::int64_t number);

}  // namespace adit::gateway
