#include "gateway/scoring.hpp"

#include <algorithm>
#include <array>

#include "codec/read.hpp"
#include "codec/write.hpp"
#include "dispatch/turn.hpp"
#include "gateway/upstream_answer.hpp"
#include "host/log.hpp"
#include "intake/icd_routes.hpp"

namespace adit::gateway {
namespace {

using dispatch::ReportEvent;

ReportEvent event_of(const uplink::Outcome& outcome) {
  if (std::holds_alternative<uplink::NeverSent>(outcome)) return ReportEvent::NeverLeft;
  if (std::holds_alternative<uplink::InDoubt>(outcome)) return ReportEvent::Lost;
  const auto& answered = std::get<uplink::Answered>(outcome);
  const ReportEvent event = dispatch::event_of(answered.status);
  // A 2xx whose body says nothing of the report may be anybody's (a captive portal's, a proxy's).
  const bool meaningless = event == ReportEvent::Recorded && !codec::read_report_reply(answered.body);
  return meaningless ? ReportEvent::Lost : event;
}

intake::Answer in_doubt_answer(std::int64_t number, const std::string& why) {
  return intake::error_answer(
      icd::Status::GatewayTimeout,
      "report " + std::to_string(number) +
          " is in doubt: it may or may not have been recorded, do not send it again (" + why + ")");
}

}  // namespace

Scoring::Scoring(loop::Loop& loop, ledger::Ledger& ledger, const settings::Settings& settings,
                 icd::BearerToken token, Record& record, std::mt19937_64& random)
    : loop_(loop),
      settings_(settings),
      record_(record),
      book_(loop, ledger),
      channel_(loop, endpoint_of(settings.command_post, settings.command_post.scoring, 0), std::move(token),
               settings.command_post.timeouts.scoring_answer),
      report_pace_(settings.command_post.rates.reports_hz, random),
      status_pace_(settings.command_post.rates.status_hz, random),
      wake_(loop.timer([this] { pump(); })),
      poll_(loop.timer([this] { poll(); })),
      deadline_(loop.timer([this] { answer_late_clients(); })) {}

std::expected<void, std::string> Scoring::start() {
  const auto waiting = book_.open();
  if (!waiting) return std::unexpected(waiting.error());
  queue_.assign(waiting->begin(), waiting->end());
  channel_.keep_warm();
  poll();
  return {};
}

void Scoring::take(const icd::ArtifactReport& report, const intake::Sender& sender,
                   std::shared_ptr<intake::Responder> responder) {
  if (stopping_) {
    responder->answer(intake::error_answer(
        icd::Status::ServiceUnavailable, "the gateway is stopping; the report was not taken, send it again"));
    return;
  }
  if (queue_.size() >= kMostWaiting) {
    responder->answer(
        intake::error_answer(icd::Status::TooManyRequests,
                             std::to_string(kMostWaiting) + " reports wait already; this one was not taken"));
    return;
  }
  const auto number = book_.add(report, sender.address);
  if (!number) {
    responder->answer(
        intake::error_answer(icd::Status::ServiceUnavailable,
                             "the report could not be written down and was not taken: " + number.error()));
    record_.changed();
    return;
  }
  queue_.push_back(*number);
  clients_[*number] = {std::move(responder), loop_.now() + settings_.reports.answer_within};
  watch_deadlines();
  record_.changed();
  pump();
}

void Scoring::status(std::shared_ptr<intake::Responder> responder) {
  if (stopping_) {
    responder->answer(intake::error_answer(icd::Status::ServiceUnavailable, "the gateway is stopping"));
    return;
  }
  if (status_fresh_until_ && loop_.now() < *status_fresh_until_) {
    responder->answer(fresh_status());
    return;
  }
  askers_.push_back({std::move(responder), loop_.now()});
  watch_deadlines();
  pump();
}

void Scoring::poll() {
  poll_due_ = true;
  pump();
}

intake::Answer Scoring::fresh_status() const {
  return {.status = icd::Status::Ok,
          .content_type = std::string(codec::kJson),
          .body = status_body_,
          .headers = {}};
}

void Scoring::pump() {
  if (stopping_ || channel_.busy()) return;
  std::array<dispatch::Candidate, 2> candidates;
  if (!queue_.empty()) candidates[0] = {loop_.now(), report_pace_.ready()};
  if (!askers_.empty() || poll_due_) candidates[1] = {loop_.now(), status_pace_.ready()};
  const dispatch::Turn turn = dispatch::in_order(candidates, loop_.now());
  if (turn.wake) wake_.call_at(*turn.wake);
  if (turn.candidate == 0) send_report();
  if (turn.candidate == 1) ask_status();
}

void Scoring::send_report() {
  const std::int64_t number = queue_.front();
  if (!book_.move(number, ReportEvent::Chosen, "")) {  // not on disk: it must not leave
    report_pace_.failed(loop_.now());
    wake_.call_at(report_pace_.ready());
    return;
  }
  queue_.pop_front();
  sending_ = number;
  report_pace_.sent(loop_.now());
  const std::string body = codec::write_artifact_report(book_.entry(number).report);
  channel_.send(icd::Uri::ArtifactReports, codec::kJson,
                icd::ChunkedBytes({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()}),
                [this, number](uplink::Outcome outcome) { report_answered(number, std::move(outcome)); });
}

void Scoring::report_answered(std::int64_t number, uplink::Outcome outcome) {
  sending_.reset();
  const ReportEvent event = event_of(outcome);
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  if (answered != nullptr) book_.set_answer(number, *answered);
  const std::string why = event == ReportEvent::Recorded ? "" : sentence_of(outcome);
  const loop::Instant now = loop_.now();
  // If this step cannot be written, the ledger still says "sending", and after a restart it is in doubt: the
  // safe side.
  book_.move(number, event, why);
  status_fresh_until_.reset();  // score and remaining reports have changed, or may have
  switch (event) {
    case ReportEvent::Recorded:
    case ReportEvent::Refused:
      report_pace_.taken(now);
      answer_client(number, client_answer(*answered));
      break;
    case ReportEvent::Throttled:
      report_pace_.throttled(now, answered->retry_after);
      queue_.push_front(number);
      break;
    case ReportEvent::NeverLeft:
      report_pace_.failed(now);
      queue_.push_front(number);
      break;
    default:
      report_pace_.taken(now);
      answer_client(number, answered != nullptr && answered->status >= 500 ? client_answer(*answered)
                                                                           : in_doubt_answer(number, why));
  }
  if (!stopping_) poll();
  record_.changed();
  pump();
}

void Scoring::answer_client(std::int64_t number, intake::Answer answer) {
  const auto client = clients_.extract(number);
  if (client) client.mapped().responder->answer(std::move(answer));
}

void Scoring::watch_deadlines() {
  std::optional<loop::Instant> first;
  if (!clients_.empty()) first = clients_.begin()->second.deadline;
  if (!askers_.empty()) first = std::min(first.value_or(asker_deadline()), asker_deadline());
  if (first) deadline_.call_at(*first);
}

loop::Instant Scoring::asker_deadline() const {
  return askers_.front().since + settings_.command_post.timeouts.scoring_answer;
}

void Scoring::answer_late_clients() {
  const loop::Instant now = loop_.now();
  while (!askers_.empty() && asker_deadline() <= now) {
    askers_.front().responder->answer(intake::error_answer(
        icd::Status::ServiceUnavailable, "the Command Post could not be asked in time: reports go first"));
    askers_.pop_front();
  }
  while (!clients_.empty() && clients_.begin()->second.deadline <= now) {
    const std::int64_t number = clients_.begin()->first;
    const ledger::Entry& entry = book_.entry(number);
    const std::string why = entry.note.empty() ? "" : ": " + entry.note;
    answer_client(number,
                  intake::error_answer(
                      icd::Status::ServiceUnavailable,
                      "report " + std::to_string(number) + " is kept and " + entry.state +
                          "; it goes out as soon as the Command Post takes it, do not send it again" + why));
  }
  watch_deadlines();
}

void Scoring::ask_status() {
  poll_due_ = false;
  status_pace_.sent(loop_.now());
  channel_.send(icd::Uri::Status, "", {},
                [this](uplink::Outcome outcome) { status_answered(std::move(outcome)); });
}

void Scoring::status_answered(uplink::Outcome outcome) {
  const loop::Instant now = loop_.now();
  poll_.call_at(now + kAskEvery);
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  if (answered == nullptr) {
    status_pace_.failed(now);
    answer_askers(intake::error_answer(icd::Status::BadGateway, sentence_of(outcome)));
  } else if (answered->status == 429) {
    status_pace_.throttled(now, answered->retry_after);
    answer_askers(client_answer(*answered));
  } else {
    status_pace_.taken(now);
    if (const auto run = codec::read_run_status(answered->body); answered->status == 200 && run) {
      run_ = *run;
      run_heard_ = loop_.stamp_now();
      status_body_ = answered->body;
      status_fresh_until_ = now + kFresh;
    }
    answer_askers(client_answer(*answered));
  }
  record_.changed();
  pump();
}

void Scoring::answer_askers(const intake::Answer& answer) {
  for (const Asker& asker : std::exchange(askers_, {})) asker.responder->answer(answer);
}

bool Scoring::stop() {
  stopping_ = true;
  answer_askers(intake::error_answer(icd::Status::ServiceUnavailable, "the gateway is stopping"));
  for (const std::int64_t number : queue_) {
    answer_client(number,
                  intake::error_answer(icd::Status::ServiceUnavailable,
                                       "the gateway is stopping; report " + std::to_string(number) +
                                           " is kept and goes out when it runs again, do not send it again"));
  }
  return !sending_;
}

void Scoring::dismiss() {
  stop();
  if (sending_)
    answer_client(*sending_, in_doubt_answer(*sending_, "the gateway stops while it is being sent"));
}

}  // namespace adit::gateway
