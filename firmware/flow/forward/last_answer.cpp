#include "forward/last_answer.hpp"

#include <variant>

#include "codec/read.hpp"
#include "dispatch/answer_text.hpp"
#include "dispatch/mapping_verdict.hpp"
#include "icd/sentence.hpp"
#include "icd/success.hpp"

namespace adit::forward {

namespace {

/// Other without a complete answer.
dispatch::Body body_of(const uplink::Outcome& outcome) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return answered != nullptr ? dispatch::body_of(answered->body) : dispatch::Body::Other;
}

/// A 2xx to GET /api/status must be a run's status (ICD 5.1).
bool lacks_status(icd::Uri uri, const uplink::Outcome& outcome) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return uri == icd::Uri::Status && answered != nullptr && icd::is_success(answered->status) &&
         !codec::read_run_status(answered->body);
}

/// A proxy before the mapping endpoint may answer it with a page. A report's answer must be JSON.
bool is_too_large(icd::Uri uri, const uplink::Outcome& outcome) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return uri != icd::Uri::Status && uri != icd::Uri::ArtifactReports && answered != nullptr &&
         answered->status == dispatch::kTooLarge;
}

bool comes_from_another(const uplink::Outcome& outcome, dispatch::Body body) {
  if (const auto* answered = std::get_if<uplink::Answered>(&outcome))
    return !answered->wants_slash && !dispatch::may_be_the_command_post(answered->status, body);
  const auto* doubt = std::get_if<uplink::InDoubt>(&outcome);
  return doubt != nullptr && doubt->too_long_status != 0 &&
         !dispatch::may_be_the_command_post(doubt->too_long_status, body);
}

}  // namespace

void LastAnswer::note(const Request& request, const uplink::Outcome& outcome) {
  heard_ = loop_.now();
  const dispatch::Body body = body_of(outcome);
  const bool no_status = lacks_status(request.uri, outcome);
  const bool too_large = is_too_large(request.uri, outcome);
  const bool is_foreign = no_status || (!too_large && comes_from_another(outcome, body));
  if (is_foreign) ++foreign_;
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  if (answered != nullptr && answered->status == 429) ++throttled_;
  if (request.is_vain) return;
  ++ended_;
  is_foreign_ = is_foreign;
  status_ = 0;
  if (answered != nullptr) {
    status_ = answered->status;
    // Only the Command Post's own clock counts.
    if (answered->date && !is_foreign_ && dispatch::is_the_command_post(status_, body)) {
      constexpr double kHalf = 0.5;  // Date has whole seconds
      date_ = static_cast<double>(answered->date->time_since_epoch().count()) + kHalf;
      dated_ = heard_;
    }
    answer_ms_ = std::chrono::duration<double, std::milli>(heard_ - request.sent_at).count();
  }
  const bool is_well = answered != nullptr && !answered->wants_slash && !is_foreign_ && status_ < 400;
  trouble_ = is_well     ? ""
             : no_status ? "the server that answered without the status of a run is not the Command Post"
             : too_large ? sentence_of(outcome, request.bytes)
                         : sentence_of(outcome);
}

void LastAnswer::forget() {
  status_ = 0;
  is_foreign_ = false;
  answer_ms_.reset();
  trouble_.clear();
}

std::optional<double> LastAnswer::time_there() const {
  if (!date_) return std::nullopt;
  return *date_ + std::chrono::duration<double>(loop_.now() - dated_).count();
}

std::string sentence_of(const uplink::Outcome& outcome, std::size_t bytes) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  if (answered != nullptr && answered->status == dispatch::kTooLarge)
    return dispatch::oversize_text(bytes, answered->body);
  return sentence_of(outcome);
}

std::string sentence_of(const uplink::Outcome& outcome) {
  if (const auto* never = std::get_if<uplink::NeverSent>(&outcome)) return never->why;
  if (const auto* doubt = std::get_if<uplink::InDoubt>(&outcome)) return doubt->why;
  const auto& answered = std::get<uplink::Answered>(outcome);
  if (answered.wants_slash)
    return icd::sentence("the Command Post answered ", answered.status, ": the path must ",
                         *answered.wants_slash ? "" : "not ", "end with a slash");
  if (dispatch::may_be_the_command_post(answered.status, dispatch::body_of(answered.body)))
    return dispatch::answer_text(answered.status, answered.body);
  return icd::sentence(
      "the server that answered ", answered.status,
      answered.status < 400 && answered.status >= 300 ? " (a redirect)" : " with a body that is not JSON",
      " is not the Command Post");
}

}  // namespace adit::forward
