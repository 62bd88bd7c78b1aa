#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "icd/geometry.hpp"
#include "icd/robot_name.hpp"
#include "icd/text.hpp"

namespace adit::icd {

/// The artifact types of the final event (ICD 5.2). Letter case does not matter.
inline constexpr auto kArtifactTypes = std::to_array<std::string_view>({
#include "icd/artifact_types.inc"
});

/// The ICD's spelling of a type, or "" if it is unknown.
constexpr std::string_view artifact_type(std::string_view text) {
  for (const std::string_view type : kArtifactTypes) {
    if (equals_ignoring_case(type, text)) return type;
  }
  return {};
}

/// The body of POST /api/artifact_reports (ICD 5.2). `type` is as the sender wrote it.
struct ArtifactReport {
  std::string type;
  Point position;
  std::optional<RobotName> robot = {};  // "name": in the ICD's example, not in its list of members
  friend bool operator==(const ArtifactReport&, const ArtifactReport&) = default;
};

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
  std::string run;  // as text, even if the Command Post sent a number
  double run_clock = 0;
  std::string report_status;  // "scored", "admin stop", "run not started", ...
  std::int64_t score_change = 0;
  std::optional<ArtifactReport> report = {};  // the report that it is about, if it has type, x, y and z
  friend bool operator==(const ReportReply&, const ReportReply&) = default;
};

}  // namespace adit::icd
