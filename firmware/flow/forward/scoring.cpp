#include "forward/scoring.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "codec/json.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "dispatch/runs.hpp"
#include "dispatch/verdicts.hpp"
#include "forward/channel.hpp"
#include "intake/answer.hpp"

namespace adit::forward {
namespace {

/// `body` with the figures of `run`. Other members stay.
std::string with_figures(const std::string& body, const icd::RunStatus& run) {
  auto status = codec::parse_json(body);
  auto* const members = status ? std::get_if<codec::Value::Object>(&status->is) : nullptr;
  if (members == nullptr) return body;
  const bool has_run_clock = codec::find_member(*members, "run_clock") != nullptr;
  for (auto& [name, value] : *members) {
    if (name == "score") value.is = run.score;
    if (name == "remaining_reports") value.is = run.remaining_reports;
    if (name == (has_run_clock ? "run_clock" : "clock")) value.is = run.run_clock;
  }
  return codec::write_json(*status);
}

}  // namespace

void StatusCache::on_status(std::string body, const icd::RunStatus& run, loop::Instant asked,
                            icd::Stamp now) {
  body_ = std::move(body);
  run_ = corrected_ = run;
  run_clock_.on_status(run.run_clock, now);
  asked_ = asked;
  fresh_ = true;
}

void StatusCache::add_report(const dispatch::Effect& effect, double run_clock, loop::Instant now) {
  if (!corrected_) return;
  if (effect.scored) {
    corrected_->remaining_reports -= 1;
    corrected_->score += effect.points.value_or(0);
  }
  const double passed = std::chrono::duration<double>(now - *asked_).count();
  const bool may_be_its_clock = run_clock - run_->run_clock <= passed + dispatch::kClockJitter;
  if (may_be_its_clock) corrected_->run_clock = std::max(corrected_->run_clock, run_clock);
  body_ = with_figures(body_, *corrected_);
}

std::optional<intake::Answer> StatusCache::answer(loop::Instant now) const {
  if (!asked_ || now - *asked_ > kOldest) return std::nullopt;
  const auto age = std::chrono::floor<std::chrono::seconds>(now - *asked_).count();
  return intake::Answer{.status = icd::Status::Ok,
                        .content_type = std::string(codec::kJson),
                        .body = body_,
                        .headers = {{"Age", std::to_string(age)}}};
}

namespace {

dispatch::ReportRules rules_of(const settings::Reports& reports) {
  return {.answer_within = reports.answer_within,
          .review = reports.review,
          .near_metres = reports.near_metres,
          .policy = {.doubt_for = reports.doubt_for, .asks = reports.doubt_asks},
          .undo = reports.undo};
}

using dispatch::Reports;

Reports::Outcome apply_action(Reports& reports, std::int64_t number, api::Action action,
                              dispatch::Time time) {
  using enum api::Action;
  switch (action) {
    case Send:
      return reports.send(number, time);
    case Hold:
      return reports.hold(number, time);
    case Withdraw:
      return reports.withdraw(number, time);
    case Settle:
      return reports.settle(number, time);
    case Resubmit:
      return reports.resubmit(number, time);
  }
  std::unreachable();
}

/// Without a recent status.
intake::Answer no_status(const std::string& why) {
  return intake::error_answer(icd::Status::ServiceUnavailable, "the status of the run is not known: " + why);
}

/// If the Command Post answered without a status.
intake::Answer no_status_in(const uplink::Answered& answered) {
  if (answered.status >= 400) return client_answer(answered);
  return intake::error_answer(icd::Status::BadGateway,
                              dispatch::answered_with(answered.status) + " without a status");
}

}  // namespace

Scoring::Scoring(loop::Loop& loop, uplink::Servers& servers, ledger::Ledger& ledger,
                 const settings::Settings& settings, std::optional<icd::BearerToken> token,
                 TrafficCounts& counts, std::mt19937_64& random, journal::Journal& journal, Clocks& clocks)
    : loop_(loop),
      ledger_(ledger),
      settings_(settings),
      counts_(counts),
      output_(loop, ledger),
      clocks_(clocks),
      reports_(std::make_unique<dispatch::Reports>(rules_of(settings.reports), output_)),
      channel_(loop, servers, "scoring", access_to_scoring(settings.command_post, std::move(token)),
               [this] { pump(); }),
      pace_(settings.command_post.rates, random, journal),
      wake_(loop.timer([this] { pump(); })),
      deadline_(loop.timer([this] { on_deadline(); })) {}

void Scoring::start(std::vector<dispatch::Run> runs) {
  reports_->on_clock_step(clocks_.clock_step());
  // On standby without the address, so that no run begins.
  reports_->open(ledger_.reports(), std::move(runs), time(), stopping_ ? "" : channel_.address());
  if (stopping_) return;
  channel_.keep_warm();
  schedule_status();
}

void Scoring::on_settings_changed() {
  reports_->set_rules(rules_of(settings_.reports));
  pace_.allow(settings_.command_post.rates, loop_.now());
  pump();
}

void Scoring::on_endpoint_changed(std::optional<icd::BearerToken> token) {
  channel_.lead_to(access_to_scoring(settings_.command_post, std::move(token)));
  if (channel_.busy()) reports_->prepare_move(address_text(settings_.command_post.scoring), time());
  pump();
}

void Scoring::on_new_command_post() {
  pace_.on_new_command_post();
  reports_paused_until_ = status_paused_until_ = {};
  status_cache_ = {};
  ask_at_ = loop_.now();
  auto next = std::make_unique<dispatch::Reports>(rules_of(settings_.reports), output_);
  next->on_clock_step(clocks_.clock_step());
  next->adopt(*reports_, time(), channel_.address());
  reports_ = std::move(next);
  watch_deadlines();
  counts_.notify_changed();
}

void Scoring::accept(const icd::ArtifactReport& report, const intake::Sender& sender,
                     std::shared_ptr<intake::Responder> responder) {
  if (stopping_)
    return responder->answer(intake::error_answer(
        icd::Status::ServiceUnavailable, "the box is stopping; the report was not accepted, send it again"));
  accept({.report = report, .sender = sender.address, .resubmit = sender.resubmits},
         output_.add(std::move(responder)));
}

void Scoring::accept(const dispatch::PostedReport& posted, dispatch::ClientId client) noexcept {
  const loop::Instant now = loop_.now();
  const bool may_send = !channel_.busy() && channel_.is_connected() &&
                        std::max(pace_.report_ready(), reports_paused_until_) <= now &&
                        !is_status_first(now) && channel_.claim_turn(/*goes_first=*/true);
  if (reports_->accept(posted, client, may_send, time())) send(*reports_->sending());
  watch_deadlines();
  counts_.notify_changed();
  pump();
}

void Scoring::status(std::shared_ptr<intake::Responder> responder) {
  if (stopping_ || !channel_.has_token())
    return responder->answer(intake::error_answer(icd::Status::ServiceUnavailable,
                                                  stopping_ ? "the box is stopping" : channel_.trouble()));
  const loop::Instant now = loop_.now();
  const auto known =
      status_cache_.is_fresh(now) || pace_.has_one_limit() ? status_cache_.answer(now) : std::nullopt;
  if (known) return responder->answer(*known);
  is_status_wanted_ = true;
  status_clients_.add(std::move(responder), now);
  pump();
  if (!asked_status_ && !can_ask_soon(now)) answer_clients(now + StatusClients::kWait);
  watch_deadlines();
}

/// No report goes first, and the pace allows it in time.
bool Scoring::can_ask_soon(loop::Instant now) const {
  const dispatch::NextRequests requests = reports_->next_requests(time());
  return !channel_.busy() && channel_.is_free() && (!requests.report || is_status_first(now)) &&
         status_ready(requests) <= now + StatusClients::kWait;
}

/// The pause that a 503 asks for delays no status that reports need.
loop::Instant Scoring::status_ready(const dispatch::NextRequests& requests) const {
  const loop::Instant ready = pace_.status_ready(requests.in_doubt);
  return requests.status ? ready : std::max(ready, status_paused_until_);
}

/// A status that no report needs goes before the next report. It never delays the report by its own pace.
bool Scoring::is_status_first(loop::Instant now) const {
  return is_status_wanted_ && reports_in_a_row_ >= kReportsInARow && !pace_.has_one_limit() &&
         std::max(status_paused_until_, pace_.status_ready(/*decides=*/false)) <=
             std::max(now, pace_.report_ready());
}

void Scoring::schedule_status() {
  ask_at_ = loop_.now();
  pump();
}

std::string Scoring::status_obstacle() const {
  if (!channel_.trouble().empty()) return channel_.trouble();
  if (!channel_.is_free())
    return "the Command Post serves one connection at a time, and another message is in flight";
  if (asked_status_) return "the Command Post has not answered yet";
  if (reports_->next_requests(time()).report) return "reports go first";
  return status_paused_until_ > loop_.now() ? "the Command Post asked for a pause"
                                            : "the Command Post is asked within a second";
}

void Scoring::pump() noexcept {
  if (!stopping_ && channel_.turns()) on_new_command_post();
  if (stopping_ || !channel_.has_token()) return;
  const dispatch::Time at = time();
  const loop::Instant now = at.now;
  reports_->set_spacing(pace_.spacing());
  dispatch::NextRequests requests = reports_->next_requests(at);
  const bool is_paused = requests.report && reports_paused_until_ > now;
  if (is_paused) requests.report = false;  // statuses go on
  if (!is_free(requests, now)) return;
  const bool is_first = is_status_first(now);
  const std::size_t report = is_first ? 1 : 0, status = is_first ? 0 : 1;
  std::array<pace::Candidate, 2> candidates;
  if (requests.report) candidates[report] = {now, pace_.report_ready()};
  const loop::Instant status_at =
      status_clients_.empty() && !is_first ? std::min(ask_at_, requests.status.value_or(ask_at_)) : now;
  if (status_at != loop::Instant::max())
    candidates[status] = {now, std::max(status_ready(requests), status_at)};
  pace::Turn turn = pace::first_ready(candidates, now);
  if (is_paused) turn.wake = std::min(turn.wake.value_or(reports_paused_until_), reports_paused_until_);
  if (turn.wake) wake_.call_at(*turn.wake);
  if (!turn.candidate || !channel_.claim_turn(/*goes_first=*/turn.candidate == report)) return;
  if (turn.candidate == report) send_next();
  if (turn.candidate == status) ask_status(/*decides=*/requests.status.has_value());
}

/// False: a request is in flight. A status that no report needs gives way to a report after a while.
bool Scoring::is_free(const dispatch::NextRequests& requests, loop::Instant now) {
  if (!channel_.busy()) return true;
  if (!asked_status_ || asked_status_->decides || !requests.report) return false;
  const loop::Instant gives_way = std::max(asked_status_->at + kGivesWayAfter, pace_.report_ready());
  if (gives_way > now) {
    wake_.call_at(gives_way);
    return false;
  }
  channel_.give_way();
  asked_status_.reset();
  pace_.on_status_lost(now);
  ask_at_ = now;
  return true;
}

void Scoring::send_next() {
  if (const dispatch::Report* const chosen = reports_->choose(time())) return send(*chosen);
  // The write failed, or it was a repeat: do not send it.
  if (!trouble().empty()) pace_.on_report_failed(loop_.now());
  wake_.call_at(std::max(pace_.report_ready(), loop_.now()));
}

void Scoring::send(const dispatch::Report& report) {
  ++reports_in_a_row_;
  pace_.on_report_sent(loop_.now());
  const std::string body = codec::write_artifact_report(report.report);
  channel_.send(icd::Uri::ArtifactReports, codec::kJson,
                icd::ChunkedBytes({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()}),
                [this](const uplink::Outcome& outcome) { on_report_answer(outcome); });
}

/// First, because the rules use the length of the silence.
void Scoring::correct_clock() {
  const auto there = channel_.last().command_post_time();
  if (there && clocks_.correct(*there)) reports_->on_clock_step(clocks_.clock_step());
}

void Scoring::on_report_answer(const uplink::Outcome& outcome) {
  classify_report(outcome);
  status_cache_.mark_stale();  // score and remaining reports may have changed
  ask_at_ = loop_.now();
  watch_deadlines();
  counts_.notify_changed();
  pump();
}

void Scoring::classify_report(const uplink::Outcome& outcome) {
  correct_clock();
  const loop::Instant now = loop_.now();
  if (const auto* answered = std::get_if<uplink::Answered>(&outcome)) {
    const std::int64_t number = reports_->sending()->number;
    const dispatch::ReportEvent event = reports_->on_answered({.status = answered->status,
                                                               .content_type = answered->content_type,
                                                               .body = answered->body,
                                                               .is_unprocessed = answered->is_unprocessed()},
                                                              time());
    correct_status(reports_->book().at(number));
    if (event == dispatch::ReportEvent::Throttled) {
      pace_.on_report_throttled(answered->sent, answered->retry_after, now);
    } else if (event == dispatch::ReportEvent::Barred) {
      pace_.on_report_barred(answered->sent, now);
    } else {
      pace_.on_report_accepted(answered->sent, now);
      reports_paused_until_ = now + UriPace::pause_of(outcome);
    }
  } else if (const auto* never = std::get_if<uplink::NeverSent>(&outcome)) {
    reports_->on_never_sent(never->why, time());
    pace_.on_report_failed(now);
  } else {
    reports_->on_lost(sentence_of(outcome), time());
    pace_.on_report_lost(now);
  }
}

/// So that a client whose report was scored sees that in the next status. An answer of another run says
/// nothing about the cached status.
void Scoring::correct_status(const dispatch::Report& answered) {
  if (answered.state != dispatch::ReportState::Answered) return;
  // A run that seemed to begin may have been the same one.
  if (!reports_->runs().can_be(status_run_, answered.run)) return;
  const auto reply = codec::read_report_reply(answered.answer);
  if (reply && !dispatch::is_about_another(*reply, answered.report))
    status_cache_.add_report(dispatch::effect_of(*reply), reply->run_clock, loop_.now());
}

void Scoring::watch_deadlines() {
  std::optional<loop::Instant> first = reports_->next_deadline();
  if (const auto end = status_clients_.first_end()) first = std::min(first.value_or(*end), *end);
  if (first) deadline_.call_at(*first);
}

/// By the known status; else they wait longer for the request in flight.
void Scoring::answer_clients(loop::Instant now) {
  if (status_clients_.empty()) return;
  const auto known = status_cache_.answer(loop_.now());
  const loop::Instant longest = !known && asked_status_ ? asked_status_->at + kSlow : now;
  status_clients_.answer_due(now, longest, known ? *known : no_status(status_obstacle()));
}

void Scoring::on_deadline() {
  answer_clients(loop_.now());
  tick();
  counts_.notify_changed();
  watch_deadlines();
}

void Scoring::tick() {
  reports_->tick(time());
  pump();
}

void Scoring::ask_status(bool decides) {
  ask_at_ = loop::Instant::max();
  is_status_wanted_ = false;
  reports_in_a_row_ = 0;
  asked_status_ = {.at = loop_.now(), .decides = decides};
  pace_.on_status_sent(asked_status_->at);
  channel_.send(icd::Uri::Status, "", {},
                [this](const uplink::Outcome& outcome) { on_status_answer(outcome); });
}

void Scoring::on_status_answer(const uplink::Outcome& outcome) {
  const loop::Instant asked = std::exchange(asked_status_, std::nullopt)->at;
  ask_at_ = channel_.is_trial_due() ? loop_.now() : loop_.now() + kAskEvery;
  classify_status(outcome, asked);
  watch_deadlines();
  counts_.notify_changed();
  pump();
}

void Scoring::classify_status(const uplink::Outcome& outcome, loop::Instant asked) {
  correct_clock();
  const loop::Instant now = loop_.now();
  const auto* answered = std::get_if<uplink::Answered>(&outcome);
  if (answered != nullptr) asked = answered->began;  // it may have waited for a connection
  const auto run = answered != nullptr && answered->status == 200 ? codec::read_run_status(answered->body)
                                                                  : std::unexpected<std::string>("");
  if (answered != nullptr && answered->wants_slash == true) {
    pace_.on_status_accepted(answered->sent, now);
    ask_at_ = now;  // clients keep waiting
    return;
  }
  if (run) status_cache_.on_status(answered->body, *run, asked, loop_.stamp_now());  // sent with its age
  if (answered == nullptr) {
    pace_.on_status_failed(outcome, now);
    status_clients_.answer_all(known_or(no_status(sentence_of(outcome))));
  } else if (answered->status == icd::kTooManyRequests) {
    pace_.on_status_throttled(answered->sent, answered->retry_after, now);
    status_clients_.answer_all(known_or(client_answer(*answered)));
  } else {
    pace_.on_status_accepted(answered->sent, now);
    status_paused_until_ = now + UriPace::pause_of(outcome);
    const bool refused = answered->status >= 400 && answered->status < 500 && !channel_.last().is_foreign();
    status_clients_.answer_all(refused ? client_answer(*answered) : known_or(no_status_in(*answered)));
  }
  if (run) {
    reports_->on_status(*run, asked, time());
    status_run_ = reports_->run().number;
  } else {
    reports_->on_status_failed(channel_.has_page_for_status() ? dispatch::NoStatus::Page
                               : std::holds_alternative<uplink::NeverSent>(outcome)
                                   ? dispatch::NoStatus::NoAnswer
                                   : dispatch::NoStatus::Other,
                               time());
  }
}

/// Failures may end within a second.
intake::Answer Scoring::known_or(intake::Answer failure) const {
  return status_cache_.answer(loop_.now()).value_or(std::move(failure));
}

dispatch::Reports::Outcome Scoring::decide(std::int64_t number, api::Action action) noexcept {
  const Reports::Outcome outcome = apply_action(*reports_, number, action, time());
  counts_.notify_changed();
  pump();
  return outcome;
}

dispatch::Reports::Outcome Scoring::report(const icd::ArtifactReport& report, bool resubmit) {
  if (stopping_) return std::unexpected("the box is stopping; the report was not accepted");
  const dispatch::ClientId nobody = output_.add_nobody();
  accept({.report = report, .sender = "operator", .resubmit = resubmit, .can_be_undone = true}, nobody);
  if (const auto number = reports_->awaited_report(nobody)) return *number;
  const dispatch::ClientAnswer told = output_.last_answer();
  if (told.number == 0) return std::unexpected(told.sentence);
  return told.number;
}

dispatch::Reports::Outcome Scoring::correct(std::int64_t number, const icd::ArtifactReport& to) noexcept {
  const dispatch::Reports::Outcome outcome = reports_->correct(number, to, time());
  watch_deadlines();
  counts_.notify_changed();
  pump();
  return outcome;
}

std::int64_t Scoring::begin_run() noexcept {
  const std::int64_t number = reports_->declare_new_run(time());
  counts_.notify_changed();
  schedule_status();
  return number;
}

void Scoring::on_link_up() {
  pace_.on_link_up();
  channel_.retry_now();
  schedule_status();  // its state is news
}

bool Scoring::stop() {
  stopping_ = true;
  status_clients_.answer_all(intake::error_answer(icd::Status::ServiceUnavailable, "the box is stopping"));
  reports_->dismiss(false);
  return reports_->sending() == nullptr;
}

void Scoring::dismiss() {
  stop();
  reports_->dismiss(true);
}

}  // namespace adit::forward
