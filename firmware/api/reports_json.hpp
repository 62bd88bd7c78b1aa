#pragma once

#include <string>
#include <vector>

#include "api/run_view.hpp"

namespace adit::api {

/// The JSON of /adit/reports: an array of rows, each member named as in ReportRow.
std::string write_reports(const std::vector<ReportRow>& reports);

/// The JSON of /adit/reports/N: a row, and with it its `history` and its `answer`.
std::string write_report(const ReportDetail& report);

}  // namespace adit::api
