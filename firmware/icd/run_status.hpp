#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "icd/artifact_report.hpp"

namespace adit::icd {

/// What GET /api/status answers (ICD 5.1). The run clock comes as `run_clock`, or as `clock` in the ICD's
/// example. What is counted comes within int32, here and in a reply: sums and differences stay in range.
struct RunStatus {
  std::int64_t score = 0;
  double run_clock = 0;  // seconds since the start of the run
  std::int64_t remaining_reports = 0;
  std::string current_team;
  friend bool operator==(const RunStatus&, const RunStatus&) = default;
};

/// What POST /api/artifact_reports answers with 200 or 201 (ICD 5.2), as far as Adit reads it; the client
/// gets the Command Post's own bytes.
struct ReportReply {
  std::int64_t id = 0;
  std::string run;  // also where the Command Post sent a number
  std::string team;
  double run_clock = 0;
  std::string report_status;  // "scored", "admin stop", "run not started", ...
  std::int64_t score_change = 0;
  std::optional<ArtifactReport> report = {};  // which it tells of, if it has type, x, y and z
  friend bool operator==(const ReportReply&, const ReportReply&) = default;
};

}  // namespace adit::icd
