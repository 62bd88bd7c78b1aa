#pragma once

#include <string>
#include <vector>

#include "api/kept_runs.hpp"

namespace adit::archive {

/// A run's report for printing on A4, black on white: one HTML file without external resources or scripts.
/// All quoted text is escaped. At most some megabytes.
std::string run_report(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports);

/// The run's map from above, with tracks and places of reports: an svg element.
std::string drawn_map(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports);
/// The known area over time: an svg element, or "" without data.
std::string drawn_coverage(const api::KeptRun& run);

}  // namespace adit::archive
