#pragma once

#include <string>

#include "api/run_view.hpp"

namespace adit::api {

/// Reports as CSV (RFC 4180) in UTF-8, with a header line and CR LF. Times are ISO 8601 in UTC. An absent
/// value is an empty cell. Spreadsheets cannot mistake text cells for formulas.
std::string csv_header();
std::string csv_line(const facts::ReportRow& row);

/// "2019-08-20T14:03:05.120Z", or "" outside the years 1970 to 9999.
std::string iso_time(Time time);

}  // namespace adit::api
