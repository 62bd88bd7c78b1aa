#pragma once

#include <string>
#include <vector>

#include "api/kept_runs.hpp"

namespace adit::archive {

/// A run's report for printing on A4, black on white: one HTML file without external resources or scripts.
/// All quoted text is escaped. At most some megabytes.
std::string run_report(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports);

/// The run's map from above, with tracks, signs for reports, axes and legend: a figure.
std::string drawn_map(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports);

}  // namespace adit::archive
