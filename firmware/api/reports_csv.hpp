#pragma once

#include <string>

#include "api/run_view.hpp"

namespace adit::api {

/// Reports as CSV (RFC 4180): a header line, lines that end in CR LF, UTF-8. Times are ISO 8601 in UTC, an
/// absent value is an empty cell, and no spreadsheet takes a cell of text for a formula.
std::string csv_header();
std::string csv_line(const ReportRow& row);

/// "2019-08-20T14:03:05.120Z"; "" for no time of the years 1970 to 9999.
std::string iso_time(Time time);

}  // namespace adit::api
