#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "icd/run_status.hpp"

namespace adit::dispatch {

/// What is known of the reports that Adit itself sent after the first one in doubt.
struct SentSince {
  std::int64_t scored = 0;  // reports that used up one of the remaining reports each
  std::int64_t points = 0;  // that they gained
};

/// What the run's status says of the reports in doubt.
enum class Finding : std::uint8_t {
  Recorded,     // all of them were
  NotRecorded,  // none of them was
  Silent,       // the status would be the same either way; a later one may tell
  Contradicts,  // it cannot be explained by Adit's own reports: the count proves nothing in this run
};

struct Evidence {
  Finding finding = Finding::Silent;
  std::string why;  // a sentence with the figures
  /// What each of them gained, if they were recorded and this is certain.
  std::optional<std::int64_t> points_each;
};

/// Compares what /api/status says now with what it would have said just before the first of `doubts` reports
/// in doubt was sent (ICD 5.1: remaining_reports, score). A recorded report lowers remaining_reports by one
/// and gains 0 or 1 point (ICD 5.2).
Evidence weigh(const icd::RunStatus& before, std::int64_t doubts, const SentSince& since,
               const icd::RunStatus& now);

}  // namespace adit::dispatch
