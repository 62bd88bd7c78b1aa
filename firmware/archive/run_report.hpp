#pragma once

#include <string>
#include <vector>

#include "api/kept_runs.hpp"

namespace adit::archive {

/// The report of a run to print, on A4 and in black on white: one HTML file that loads nothing, has no
/// script, and escapes all that it quotes. At most some megabytes.
std::string run_report(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports);

/// Its map, seen from above, with tracks and the places of reports: an element svg.
std::string drawn_map(const api::KeptRun& run, const std::vector<api::ReportDetail>& reports);
/// How much was known over time: an element svg; "" where nothing was.
std::string drawn_coverage(const api::KeptRun& run);

}  // namespace adit::archive
