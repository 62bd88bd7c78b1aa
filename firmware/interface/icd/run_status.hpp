#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "icd/artifact_report.hpp"

namespace adit::icd {

/// The answer to GET /api/status (ICD 5.1). The run clock is named `run_clock`, or `clock` as in the ICD's
/// example. Counts are within int32, here and in a reply, so that sums and differences stay in range.
struct RunStatus {
  std::int64_t score = 0;
  double run_clock = 0;  // seconds since the start of the run
  std::int64_t remaining_reports = 0;
  std::string current_team;
  friend bool operator==(const RunStatus&, const RunStatus&) = default;
};

/// The members that Adit reads of an answer to POST /api/artifact_reports with 200 or 201 (ICD 5.2). The
/// client gets the Command Post's original bytes.
struct ReportReply {
  std::int64_t id = 0;
  std::string run;  // as text, even if the Command Post sent a number
  std::string team;
  double run_clock = 0;
  std::string report_status;  // "scored", "admin stop", "run not started", ...
  std::int64_t score_change = 0;
  std::optional<ArtifactReport> report = {};  // the report that it is about, if it has type, x, y and z
  friend bool operator==(const ReportReply&, const ReportReply&) = default;
};

}  // namespace adit::icd
