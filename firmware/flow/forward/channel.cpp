#include "forward/channel.hpp"

#include <utility>
#include <variant>

#include "codec/json.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "dispatch/verdicts.hpp"
#include "host/log.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"
#include "intake/answer.hpp"

namespace adit::forward {
intake::Answer client_answer(const uplink::Answered& answered) {
  const auto status = static_cast<icd::Status>(answered.status);
  if (const auto json = codec::parse_json(answered.body)) {
    const bool as_it_came = answered.status < 300 || std::holds_alternative<std::string>(json->is);
    if (!as_it_came)
      return intake::error_answer(status, dispatch::answer_text(answered.status, answered.body));
    return {
        .status = status, .content_type = std::string(codec::kJson), .body = answered.body, .headers = {}};
  }
  const std::string sentence =
      dispatch::answered_with(answered.status) +
      (answered.body.empty() ? " with an empty body" : " with a body that is not JSON");
  return intake::error_answer(answered.status < 400 ? icd::Status::BadGateway : status, sentence);
}

namespace {

/// Other without a complete answer.
dispatch::Body body_of(const uplink::Outcome& outcome) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return answered != nullptr ? dispatch::body_of(answered->body) : dispatch::Body::Other;
}

/// A 2xx to GET /api/status must be a run's status (ICD 5.1).
bool lacks_status(icd::Uri uri, const uplink::Outcome& outcome) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return icd::reply_of(uri) == icd::Reply::RunStatus && answered != nullptr &&
         icd::is_success(answered->status) && !codec::read_run_status(answered->body);
}

/// A proxy before the mapping endpoint may answer it with a page. A report's answer must be JSON.
bool is_too_large(icd::Uri uri, const uplink::Outcome& outcome) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return icd::endpoint_of(uri) == icd::Endpoint::Mapping && answered != nullptr &&
         answered->status == dispatch::kTooLarge;
}

bool is_other_server(const uplink::Outcome& outcome, dispatch::Body body) {
  if (const auto* answered = std::get_if<uplink::Answered>(&outcome))
    return !answered->wants_slash && !dispatch::is_plausible_answer(answered->status, body);
  const auto* doubt = std::get_if<uplink::InDoubt>(&outcome);
  return doubt != nullptr && doubt->too_long_status != 0 &&
         !dispatch::is_plausible_answer(doubt->too_long_status, body);
}

}  // namespace

void LastAnswer::note(const Request& request, const uplink::Outcome& outcome) {
  heard_ = loop_.now();
  const dispatch::Body body = body_of(outcome);
  const bool no_status = lacks_status(request.uri, outcome);
  const bool too_large = is_too_large(request.uri, outcome);
  const bool is_foreign = no_status || (!too_large && is_other_server(outcome, body));
  if (is_foreign) ++foreign_;
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  if (answered != nullptr && answered->status == icd::kTooManyRequests) ++throttled_;
  if (request.is_vain) return;
  ++ended_;
  is_foreign_ = is_foreign;
  status_ = 0;
  if (answered != nullptr) {
    status_ = answered->status;
    // Only the Command Post's own clock counts.
    if (answered->date && !is_foreign_ && dispatch::is_from_command_post(status_, body)) {
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

std::optional<double> LastAnswer::command_post_time() const {
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
  if (dispatch::is_plausible_answer(answered.status, dispatch::body_of(answered.body)))
    return dispatch::answer_text(answered.status, answered.body);
  return icd::sentence(
      "the server that answered ", answered.status,
      answered.status < 400 && answered.status >= 300 ? " (a redirect)" : " with a body that is not JSON",
      " is not the Command Post");
}

namespace {

/// Bytes. A status is small, a mapping answer is null or a wrong address's text.
std::size_t longest_answer_to(icd::Uri uri) {
  return icd::reply_of(uri) == icd::Reply::RunStatus ? 16u << 10 : uplink::Request::kLongestAnswer;
}

/// A 2xx with a web page, of any length.
bool is_success_page(const uplink::Outcome& outcome) {
  if (const auto* doubt = std::get_if<uplink::InDoubt>(&outcome))
    return icd::is_success(doubt->too_long_status);
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return answered != nullptr && icd::is_success(answered->status) &&
         dispatch::body_of(answered->body) == dispatch::Body::Other;
}

bool can_concern_message(const uplink::Outcome& outcome) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return answered != nullptr && dispatch::can_concern_part(answered->status);
}

/// The server has a status at this path, or rejects the token there.
bool knows_path(const uplink::Outcome& outcome) {
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  return answered != nullptr && (answered->status == 401 || codec::read_run_status(answered->body));
}

}  // namespace

Channel::Channel(loop::Loop& loop, uplink::Servers& servers, const char* name, EndpointAccess way,
                 std::function<void()> turn_came)
    : loop_(loop), servers_(servers), name_(name), turn_came_(std::move(turn_came)), last_(loop) {
  set_access(std::move(way));
}

bool Channel::leads_elsewhere(const EndpointAccess& way) const {
  return address_text({way.endpoint.address, way.endpoint.port}) != address_ || !icd::same(way.token, token_);
}

void Channel::give_up() {
  if (!next_ || !busy() || !leads_elsewhere(*next_)) return;
  finished_bytes_ += connection_->sent_bytes();
  connection_.reset();
  const uplink::InDoubt doubt{.why = "it was in flight to " + address_ +
                                     " when the settings named another address"};
  for (const auto& request : std::vector(under_way_)) on_ended(request, doubt);
}

void Channel::give_way() {
  icd::require(under_way_.size() == 1);
  under_way_.clear();
  connection_->give_up();
}

bool Channel::turns() {
  if (!next_ || busy()) return false;
  if (connection_) finished_bytes_ += connection_->sent_bytes();
  const bool is_elsewhere = leads_elsewhere(*next_);
  set_access(*std::exchange(next_, std::nullopt));
  if (!is_elsewhere) return false;
  wants_slash_ = has_page_ = is_trial_due_ = was_serial_ = false;
  reports_want_slash_.reset();
  last_.forget();
  return true;
}

void Channel::set_access(EndpointAccess way) {
  auto server = servers_.at(way.endpoint);  // first: another token does not change the server
  connection_.reset();
  address_ = address_text({way.endpoint.address, way.endpoint.port});
  token_ = way.token;
  answer_within_ = way.answer_within;
  if (!way.token) return;
  connection_.emplace(loop_, std::move(way.endpoint), std::move(*way.token), std::move(server), turn_came_);
  if (keeps_warm_) connection_->keep_warm();
}

void Channel::send(icd::Uri uri, std::string_view content_type, icd::ChunkedBytes body,
                   std::function<void(uplink::Outcome)> done, loop::Instant last_byte_not_before,
                   bool is_on_trial) {
  icd::require(has_token() && (!busy() || can_go_ahead()));
  finished_bytes_ += connection_->sent_bytes();
  const bool is_trial = icd::reply_of(uri) == icd::Reply::RunStatus && is_trial_due_;
  const bool is_report = icd::reply_of(uri) == icd::Reply::Report;
  const bool has_slash = is_report ? reports_want_slash_.value_or(wants_slash_) : wants_slash_ != is_trial;
  const auto under_way = std::make_shared<InFlightRequest>(loop_.now(), uri, body.size(), has_slash, is_trial,
                                                           is_on_trial, std::move(done));
  connection_->send({.method = std::string(icd::method_of(uri)),
                     .target = std::string(icd::path_of(uri)) + (has_slash ? "/" : ""),
                     .content_type = std::string(content_type),
                     .body = std::move(body),
                     .answer_within = answer_within_,
                     .longest_answer = longest_answer_to(uri),
                     .last_byte_not_before = last_byte_not_before},
                    [this, under_way](uplink::Outcome outcome) { on_ended(under_way, std::move(outcome)); });
  under_way_.push_back(under_way);
}

std::optional<uplink::SendTimes> Channel::has_arrived() const {
  return connection_ ? connection_->has_arrived() : std::nullopt;
}

void Channel::on_ended(const std::shared_ptr<InFlightRequest>& request, uplink::Outcome outcome) {
  const bool is_vain =
      (request->is_trial && !knows_path(outcome)) || (request->is_on_trial && can_concern_message(outcome));
  last_.note({.uri = request->uri, .sent_at = request->sent_at, .bytes = request->bytes, .is_vain = is_vain},
             outcome);
  learn_path(*request, outcome);
  if (is_serial() && !std::exchange(was_serial_, true))
    host::log(host::Level::Notice,
              "the Command Post serves one connection at a time; requests to it go one after the other",
              {{"endpoint", name_}, {"address", address_}});
  std::erase(under_way_, request);
  const auto done = std::move(request->done);
  done(std::move(outcome));
}

void Channel::learn_path(const InFlightRequest& request, const uplink::Outcome& outcome) {
  const bool is_status = icd::reply_of(request.uri) == icd::Reply::RunStatus;
  const bool is_page = is_status && is_success_page(outcome);
  if (is_status) is_trial_due_ = is_page && !request.is_trial;
  if (is_page) has_page_ = true;
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  if (answered == nullptr) return;
  bool wants_slash = wants_slash_;
  if (request.is_trial) {
    if (!knows_path(outcome)) return;
    wants_slash = request.has_slash;
  } else {
    // The measured mapping server answers 501 to an unknown path.
    const bool is_unknown = answered->status == 404 || answered->status == 501;
    if (icd::reply_of(request.uri) == icd::Reply::Report) {
      if (is_unknown) reports_want_slash_.reset();
      if (answered->is_unprocessed()) reports_want_slash_ = answered->wants_slash;
    } else if (answered->wants_slash) {
      wants_slash = *answered->wants_slash;
    }
    if (request.has_slash && is_unknown) wants_slash = false;
  }
  if (is_status && !is_page) has_page_ = false;
  if (std::exchange(wants_slash_, wants_slash) == wants_slash) return;
  host::log(
      host::Level::Notice,
      wants_slash
          ? "the Command Post wants a slash at the end of paths; paths have one from now on"
          : "the Command Post does not know paths with a slash at the end; paths have no slash from now on",
      {{"endpoint", name_}, {"address", address_}, {"status", std::to_string(answered->status)}});
}

std::string Channel::trouble() const {
  if (!connection_) return std::string("no ") + name_ + " token is set";
  if (!last_.trouble().empty()) return last_.trouble();
  return is_connected() ? "" : connection_->trouble();
}

EndpointAccess access_to_scoring(const settings::CommandPost& command_post,
                                 std::optional<icd::BearerToken> token) {
  return {endpoint_of(command_post, command_post.scoring, 0), std::move(token),
          command_post.timeouts.scoring_answer};
}

EndpointAccess access_to_mapping(const settings::CommandPost& command_post,
                                 std::optional<icd::BearerToken> token, std::uint64_t bytes_per_second) {
  return {endpoint_of(command_post, command_post.mapping, bytes_per_second), std::move(token),
          command_post.timeouts.mapping_answer};
}

uplink::Endpoint endpoint_of(const settings::CommandPost& command_post, const settings::Address& address,
                             std::uint64_t bytes_per_second) {
  return {.address = address.address,
          .port = address.port,
          .interface = command_post.interface,
          .bytes_per_second = bytes_per_second,
          .connect_within = command_post.timeouts.connect};
}

std::string address_text(const settings::Address& address) {
  return address.address + ":" + std::to_string(address.port);
}

}  // namespace adit::forward
