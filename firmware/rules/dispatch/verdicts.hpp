#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "dispatch/report.hpp"
#include "icd/status.hpp"

namespace adit::dispatch {

/// The kind of a body by its bytes. Content-Type is ignored.
enum class Body : std::uint8_t { Empty, Json, Other };
Body body_of(std::string_view body);

/// Whether a Command Post may have sent this answer: JSON, an empty body, or a page with 404, 429 or 5xx.
/// Redirects and other pages come from other machines, such as a captive portal.
bool is_plausible_answer(int status, Body body);
/// 2xx with JSON. An error does not identify the Command Post, because proxies send JSON errors.
bool is_from_command_post(int status, Body body);

/// 413 to a map, a state or markers.
inline constexpr int kTooLarge = static_cast<int>(icd::Status::ContentTooLarge);

enum class MappingVerdict : std::uint8_t {
  Taken,      // 2xx with JSON or an empty body
  Throttled,  // 429: retry more slowly
  Refused,    // 400, 422 with JSON or an empty body: do not retry
  TooLarge,   // 413 with any body: send less; the Command Post or a proxy before it has a limit
  Suspect,    // 409, 415, 500, or 400, 422 with a page: at fault if others pass (queues::Blame)
  Failing,    // all others: retry
};
MappingVerdict mapping_verdict(int status, Body body);
/// Whether only a part of the message may have failed, such as one robot's pose: any answer but 2xx and 429.
bool can_concern_part(int status);

/// The answer's text for people: a JSON string, an object's `detail`, or else the status. Cut at 300 bytes.
std::string answer_text(int status, std::string_view body);

/// "too large (1440 kB): the Command Post answered 413"
std::string oversize_text(std::size_t bytes, std::string_view body);

/// "the Command Post answered 404"
std::string answered_with(int status);

/// The event that an answer causes (table in README.md). Lost: 2xx without a report, pages, 3xx, 408 and 5xx.
/// A proxy may send these after the Command Post has recorded the report. `is_unprocessed`: the server
/// redirects to the same path with or without a slash at its end, and did not process the report.
ReportEvent event_of(int status, bool tells_of_a_report, Body body, bool is_unprocessed = false);

/// True if the answer is about a report of another type, or over a metre away. Servers may round coordinates.
bool is_about_another(const icd::ReportReply& reply, const icd::ArtifactReport& report);

/// Effect of a report on the run.
struct Effect {
  bool scored = false;                     // it used up one of the remaining reports
  bool again = false;                      // not scored (admin stop, run not started): worth posting again
  std::optional<std::int64_t> points = 0;  // nullopt: uncertain
};
Effect effect_of(const icd::ReportReply& reply);
/// From the report's stored answer. Effect{} if the report was not recorded. The points are uncertain if it
/// was found recorded with others, of which some scored, or if the answer is about another report.
Effect effect_of(const Report& report);

}  // namespace adit::dispatch
