#pragma once

#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "cli/words.hpp"

namespace adit::cli {

/// It stays where it is until the operator decides.
bool needs_the_operator(const api::ReportRow& report);
/// Nothing more happens to it, nor is there anything to decide.
bool is_finished(const api::ReportRow& report);

/// Where a report is in its life, as the operator is told: "held", "in doubt, asking", "same as 3".
std::string life_of(const api::ReportRow& report);
Tone tone_of(const api::ReportRow& report);
/// "201, scored", "found out, scored", or "".
std::string said_of(const api::ReportRow& report);
/// "+1", "0", or "" where it is not known.
std::string gained_by(const api::ReportRow& report);

/// What `adit reports` prints. `others`: how many reports of other runs are not among them.
std::string reports_text(const std::vector<api::ReportRow>& reports, std::size_t others, api::Time now,
                         bool colour);

}  // namespace adit::cli
