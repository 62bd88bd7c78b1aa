#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "icd/run_status.hpp"

namespace adit::dispatch {

/// Effect of Adit's reports after the first one in doubt.
struct SentSince {
  std::int64_t scored = 0;  // remaining reports that they used up
  std::int64_t points = 0;  // points that they gained
};

/// What the run's status shows about all reports in doubt.
enum class Finding : std::uint8_t {
  Recorded,
  NotRecorded,
  Silent,       // the status does not show it; a later one may
  Contradicts,  // Adit's own reports do not explain the counts, so the counts prove no report in this run
};

struct Evidence {
  Finding finding = Finding::Silent;
  std::string why;  // a sentence with the figures
  /// Points of each report, if certain.
  std::optional<std::int64_t> points_each;
};

/// Compares the present status with the status expected before the first of `doubts` reports was sent. A
/// recorded report lowers remaining_reports by one (ICD 5.1) and gains 0 or 1 point (ICD 5.2).
Evidence weigh(const icd::RunStatus& before, std::int64_t doubts, const SentSince& since,
               const icd::RunStatus& now);

}  // namespace adit::dispatch
