#pragma once

#include <string>
#include <vector>

#include "api/run_view.hpp"

namespace adit::api {

/// The reports as RFC 4180 has it: a header line, lines that end in CR LF, UTF-8. Times are ISO 8601 in UTC,
/// what is absent is empty, and no cell of text can be taken for a formula by a spreadsheet.
std::string write_reports_csv(const std::vector<ReportRow>& reports);

/// "2019-08-20T14:03:05.120Z"; "" for no time of the years 1970 to 9999.
std::string iso_time(Time time);

}  // namespace adit::api
