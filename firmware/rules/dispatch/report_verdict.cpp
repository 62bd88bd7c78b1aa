#include "dispatch/report_verdict.hpp"

#include "codec/read.hpp"
#include "dispatch/same_report.hpp"
#include "icd/success.hpp"

namespace adit::dispatch {

ReportEvent event_of(int status, bool tells_of_a_report, Body body, bool is_unprocessed) {
  if (is_unprocessed) return ReportEvent::Redirected;
  if (icd::is_success(status)) {
    return tells_of_a_report ? ReportEvent::Recorded : ReportEvent::Lost;
  }
  switch (status) {
    case 401:
    case 403:
    case 404:
    case 405:
    case 407:
      return ReportEvent::Barred;
    case 408:
      return ReportEvent::Lost;
    case 429:
      return ReportEvent::Throttled;
    default:
      if (status < 400 || status >= 500 || body == Body::Other) return ReportEvent::Lost;
      return ReportEvent::Rejected;
  }
}

bool is_about_another(const icd::ReportReply& reply, const icd::ArtifactReport& report) {
  constexpr double kRounded = 1;  // metres
  return reply.report && !is_near(*reply.report, report, kRounded);
}

Effect effect_of(const icd::ReportReply& reply) {
  return {.scored = reply.report_status == "scored",
          .again = reply.report_status == "admin stop" || reply.report_status == "run not started",
          .points = reply.score_change};
}

Effect effect_of(const Report& report) {
  const bool found = report.state == ReportState::Settled && report.reconciled;
  if (report.state != ReportState::Answered && !found) return {};
  const auto reply = codec::read_report_reply(report.answer);
  if (!reply) return {.scored = found, .points = std::nullopt};
  Effect effect = effect_of(*reply);
  if (is_about_another(*reply, report.report)) effect.points.reset();
  return effect;
}

}  // namespace adit::dispatch
