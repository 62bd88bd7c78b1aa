#include "dispatch/verdicts.hpp"

#include "codec/json.hpp"
#include "codec/read.hpp"
#include "dispatch/report.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"
#include "icd/text.hpp"

namespace adit::dispatch {
namespace {

/// A handler of the Command Post failed at a message. Proxies send other 5xx.
constexpr int kHandlerFailed = 500;

}  // namespace

Body body_of(std::string_view body) {
  constexpr std::string_view kSpace = " \t\r\n";
  if (body.find_first_not_of(kSpace) == std::string_view::npos) return Body::Empty;
  return codec::parse_json(body) ? Body::Json : Body::Other;
}

bool is_plausible_answer(int status, Body body) {
  if (status >= 300 && status < 400) return false;
  return body != Body::Other || status == 404 || status == icd::kTooManyRequests || status >= 500;
}

bool is_from_command_post(int status, Body body) {
  return icd::is_success(status) && body == Body::Json;
}

MappingVerdict mapping_verdict(int status, Body body) {
  if (icd::is_success(status)) return body == Body::Other ? MappingVerdict::Failing : MappingVerdict::Taken;
  if (status == icd::kTooManyRequests) return MappingVerdict::Throttled;
  if (status == kTooLarge) return MappingVerdict::TooLarge;
  if (status == 409 || status == 415 || status == kHandlerFailed) return MappingVerdict::Suspect;
  if (status == 400 || status == 422) {
    return body == Body::Other ? MappingVerdict::Suspect : MappingVerdict::Refused;
  }
  return MappingVerdict::Failing;
}

bool can_concern_part(int status) {
  return status >= 300 && status != icd::kTooManyRequests;
}

namespace {

constexpr std::size_t kLongestSentence = 300;

std::string cut(std::string text) {
  if (text.size() <= kLongestSentence) return text;
  text.resize(icd::beginning_of(text, kLongestSentence).size());
  return text + "...";
}

}  // namespace

std::string answered_with(int status) {
  return icd::sentence("the Command Post answered ", status);
}

std::string oversize_text(std::size_t bytes, std::string_view body) {
  constexpr std::size_t kKilobyte = 1000;
  return icd::sentence("too large (", (bytes + kKilobyte - 1) / kKilobyte,
                       " kB): ", answer_text(kTooLarge, body));
}

std::string answer_text(int status, std::string_view body) {
  const auto value = codec::parse_json(body);
  if (!value) return answered_with(status);
  if (const auto* text = std::get_if<std::string>(&value->is)) return cut(*text);
  if (const auto* object = std::get_if<codec::Value::Object>(&value->is)) {
    for (const auto& [name, member] : *object) {
      const auto* detail = std::get_if<std::string>(&member.is);
      if (name == "detail" && detail != nullptr) return cut(*detail);
    }
    if (status >= 400 && !object->empty())
      return cut(answered_with(status) + ": " + codec::write_json(*value));
  }
  return answered_with(status);
}

ReportEvent event_of(int status, bool tells_of_a_report, Body body, bool is_unprocessed) {
  if (is_unprocessed) return ReportEvent::Redirected;
  if (icd::is_success(status)) {
    return tells_of_a_report ? ReportEvent::Recorded : ReportEvent::Lost;
  }
  if (icd::concerns_all_messages(status)) return ReportEvent::Barred;
  if (status == icd::kTooManyRequests) return ReportEvent::Throttled;
  const bool is_rejected = status >= 400 && status < 500 && status != 408 && body != Body::Other;
  return is_rejected ? ReportEvent::Rejected : ReportEvent::Lost;
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
