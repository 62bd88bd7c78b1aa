#pragma once

#include <expected>
#include <string>
#include <string_view>

namespace adit::robots {

/// What a client shows its operator of a refusal: the JSON string or {"detail": ...} that the server sent,
/// else the first line of whatever came ("not JSON: ...").
std::string sentence_of(std::string_view body);

/// What clients read of the answer to a report (ICD 5.2), and insist on.
struct ReportAnswer {
  std::string type;
  double x = 0, y = 0, z = 0;
  double run_clock = 0;
  std::string report_status;
  int score_change = 0;
};

/// Or which member is not there as it should be.
std::expected<ReportAnswer, std::string> parse_report_answer(std::string_view body);

/// "score 3, 22 reports left, run clock 41 s"; or what is wrong with the answer to GET /api/status.
std::expected<std::string, std::string> parse_status_answer(std::string_view body);

}  // namespace adit::robots
