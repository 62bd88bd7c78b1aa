#include "dispatch/reports.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "codec/read.hpp"
#include "dispatch/report.hpp"
#include "dispatch/verdicts.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {

/// Reports that were in flight at the end of the last process.
void Reports::doubt_in_flight(Time time) {
  for (const auto& [number, report] : book_.all()) {
    last_sending_ = std::max(last_sending_, report.sending);
  }
  while (book_.sending() != nullptr) {
    on_ended(ReportEvent::Restarted, "the box stopped while it was in flight", time);
  }
}

/// Certainly meant for the present run. Without a status, a young report or one sent on purpose may go.
bool Reports::can_send(const Report& report, Instant now) const {
  if (barred_ || (is_page_ && !ordered_.contains(report.number))) return false;
  if (doubts_.is_pending(now)) return false;
  if (account_.is_fresh(now)) return true;
  if (!account_.is_dumb(now) || review_.other_command_post_twin(report) != nullptr) return false;
  return report.asked || clients_.is_young(report, now);
}

/// Whether a report that is posted now may be sent at once.
bool Reports::can_go_first(const Report& report, Instant now) const {
  return book_.sending() == nullptr && account_.waiting_here().empty() && can_send(report, now);
}

std::optional<std::int64_t> Reports::next(Instant now) const {
  for (const std::int64_t number : account_.waiting_here()) {
    if (can_send(book_.at(number), now)) return number;
  }
  return std::nullopt;
}

NextRequests Reports::next_requests(Time time) const {
  if (book_.sending() != nullptr) return {};
  NextRequests requests;
  requests.status = doubts_.next_ask(time.now);
  requests.in_doubt = requests.status.has_value();
  if (account_.waiting_here().empty()) return requests;
  requests.report = next(time.now).has_value();
  if (barred_ || is_page_ || !account_.is_fresh(time.now)) requests.status = time.now;
  return requests;
}

/// The comparison that Reports::accept() left out because the run was unknown. False: do not send it now.
bool Reports::check(std::int64_t number, Time time) {
  const Report report = book_.at(number);
  if (report.run != account_.run().number && !report.asked && !clients_.is_young(report, time.now)) {
    book_.move({number, ReportEvent::Held, "a new run began (" + account_.run().why + ")"}, time);
    return false;
  }
  if (!review_.is_unchecked(number)) return true;
  const Report* const same = report.asked ? nullptr : review_.earlier(report);
  if (same != nullptr) {
    const std::int64_t original = same->number;
    const bool joined =
        book_.move({number, ReportEvent::Joined, icd::sentence("the same as report ", original),
                    [original](Report& moved) { moved.same_as = original; }},
                   time);
    if (joined) {
      review_.on_compared(number);
      clients_.hand_over(number, book_.at(original));
    }
    return false;
  }
  if (const Hold hold = review_.reason_to_hold(report); !hold.why.empty()) {
    const auto keep = [&hold](Report& held) { held.same_as = hold.same_as; };
    if (book_.move({number, ReportEvent::Held, hold.why, keep}, time)) review_.on_compared(number);
    return false;
  }
  review_.on_compared(number);
  return true;
}

const Report* Reports::choose(Time time) {
  while (const auto number = next(time.now)) {
    if (check(*number, time)) {
      const bool chosen = book_.move(
          {*number, ReportEvent::Chosen, "", [&](Report& report) { prepare(report, time); }}, time);
      return chosen ? &book_.at(*number) : nullptr;
    }
    if (book_.at(*number).state == ReportState::Queued) return nullptr;  // the write failed
  }
  return nullptr;
}

/// Sets the fields that decide a doubt. Written before the bytes leave, they survive a crash.
void Reports::prepare(Report& report, Time time) {
  report.run = account_.run().number;
  report.sending = ++last_sending_;
  report.sent = time.stamp;
  report.before = doubts_.has_open_group() ? std::nullopt : account_.expected_status(time.now);
  report.beside = report.before ? doubts_.open_count() : 0;
  report.counted = false;
  report.uncertain.clear();
  report.status = 0;
  report.content_type.clear();
  report.answer.clear();
}

/// For the report in flight. A new run may have begun meanwhile: either may have recorded it.
void Reports::on_ended(ReportEvent event, const std::string& note, Time time, const ReportBook::Edit& edit) {
  const bool is_lost = event == ReportEvent::Lost || event == ReportEvent::Restarted;
  book_.move({book_.sending()->number, event, note,
              [&](Report& report) {
                if (is_lost) ++report.tries;
                if (edit) edit(report);
                const bool enters = is_lost || clients_.is_young(report, time.now);
                if (!enters || report.run == account_.run().number) return;
                report.run = account_.run().number;
                report.before.reset();
              }},
             time);
}

ReportEvent Reports::on_answered(const HttpAnswer& answer, Time time) {
  const auto reply = codec::read_report_reply(answer.body);
  const Report* const another = reply ? find_other_report(*reply) : nullptr;
  const ReportEvent event = event_of(answer.status, reply && another == nullptr,
                                     reply ? Body::Json : body_of(answer.body), answer.is_unprocessed);
  const auto keep = [&](Report& report) {
    report.status = answer.status;
    report.content_type = answer.content_type;
    report.answer = answer.body;
  };
  barred_ = event == ReportEvent::Barred;
  if (event == ReportEvent::Recorded) {
    on_recorded(keep, *reply, time);
  } else {
    const std::string note =
        another != nullptr && event == ReportEvent::Lost
            ? icd::sentence("the answer is for report ", another->number, ", not for this report")
            : answer_text(answer.status, answer.body);
    on_ended(event, note, time, keep);
  }
  return event;
}

/// The other sent report in `reply`, or null. Servers and proxies may repeat an answer: no evidence here.
const Report* Reports::find_other_report(const icd::ReportReply& reply) const {
  if (!reply.report || is_same(*reply.report, book_.sending()->report)) return nullptr;
  for (const Report* const other : book_.find_same(*reply.report)) {
    if (other->number != book_.sending()->number && other->sending != 0) return other;
  }
  return nullptr;
}

void Reports::on_recorded(const ReportBook::Edit& keep, const icd::ReportReply& reply, Time time) {
  changes_.detect_change(reply, time);  // the answer decides the run
  const Effect effect = effect_of(reply);
  const bool is_strange = is_about_another(reply, book_.sending()->report);
  std::string note;
  if (effect.again) {
    note = "not scored (" + reply.report_status + "); post it again when the run continues";
  } else if (reply.report && !is_same(*reply.report, book_.sending()->report)) {
    note = "the answer is for " + describe(*reply.report);
  }
  on_ended(ReportEvent::Recorded, note, time, [&](Report& report) {
    keep(report);
    report.run = account_.run().number;
  });
  account_.on_answered(reply, time);
  if (is_strange) account_.forget_expected();
}

Reports::Reports(const ReportRules& rules, Output& output)
    : rules_(rules),
      output_(output),
      book_(output,
            [this](std::int64_t number, ReportAction action, Time time) { follow(number, action, time); }),
      account_(book_),
      review_(rules_, book_, account_),
      doubts_(rules_.policy, book_, account_, review_),
      clients_(book_, account_, output),
      changes_(book_, account_, review_, doubts_, clients_) {}

void Reports::open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post) {
  book_.open(std::move(all));
  begin(std::move(runs), time, post);
}

void Reports::adopt(Reports& before, Time time, const std::string& post) {
  icd::require(before.sending() == nullptr);
  clients_.adopt(before.clients_);  // first, so that begin() can answer them
  book_.adopt(before.book_);
  const auto runs = before.runs().all() | std::views::values;
  begin({runs.begin(), runs.end()}, time, post);
}

void Reports::begin(std::vector<Run> runs, Time time, const std::string& post) {
  std::int64_t latest_run = 1;
  for (const auto& [number, report] : book_.all()) latest_run = std::max(latest_run, report.run);
  account_.open(std::move(runs), latest_run, post);
  doubt_in_flight(time);
  for (const std::int64_t number : book_.waiting()) review_.compare_later(number);
  doubts_.open();
  doubts_.begin(time.now);
  if (!post.empty() && run().post != post) changes_.change_command_post(post, time);
}

void Reports::follow(std::int64_t number, ReportAction action, Time time) {
  switch (action) {
    case ReportAction::Nothing:
    case ReportAction::Send:  // by the caller
      break;
    case ReportAction::AnswerClients:
    case ReportAction::TellClients:
      clients_.answer_all(number);
      break;
    case ReportAction::Ask:
      doubts_.on_lost(number, time.now);
      break;
  }
}

bool Reports::accept(const PostedReport& posted, ClientId client, bool may_send, Time time) {
  Report report{
      .report = posted.report, .sender = posted.sender, .received = time.stamp, .changed = time.stamp};
  report.run = expected_run().number;
  report.asked = posted.resubmit;
  const bool fresh = is_fresh(time.now);
  const Report* const same = review_.earlier(report);
  // A finished report's run may have ended unnoticed: check() compares later.
  const bool repeats = same != nullptr && (fresh || !is_final(same->state));
  if (repeats && (!report.asked || (same->asked && !is_final(same->state)))) {
    if (is_final(same->state)) {
      clients_.answer_client(client, *same);
    } else {
      clients_.on_posted(same->number, time.now);
      clients_.add(client, same->number, time.now + rules_.answer_within);
    }
    return false;
  }
  if (account_.waiting_at(expected_run().post).size() >= rules_.most_waiting) {
    output_.answer_client(
        client,
        {.status = icd::Status::TooManyRequests,
         .sentence =
             icd::sentence(rules_.most_waiting, " reports are queued already; this report was not accepted")},
        report);
    return false;
  }
  Hold hold = fresh ? review_.reason_to_hold(report) : Hold{};
  if (posted.can_be_undone && hold.why.empty()) hold = review_.hold_for_undo();
  if (const Report* const other = review_.other_command_post_twin(report); other != nullptr) {
    report.note = icd::sentence("the same as report ", other->number,
                                ", sent to another Command Post; queued until the Command Post at ",
                                run().post, " answers");
  }
  return accept_new(std::move(report), hold, client, may_send, time);
}

bool Reports::accept_new(Report report, const Hold& hold, ClientId client, bool may_send, Time time) {
  const bool fresh = is_fresh(time.now);
  // Accepting and choosing in one write flush the disk once.
  const bool now = may_send && hold.why.empty() && fresh && can_go_first(report, time.now);
  const std::int64_t number = add(report, hold, now, time);
  if (number == 0) {
    output_.answer_client(
        client, {.sentence = "the report could not be stored and was not accepted; post it again"}, report);
    return false;
  }
  clients_.add(client, number, time.now + rules_.answer_within);
  if (!fresh) review_.compare_later(number);
  return now;
}

/// In one write after `before`. `now`: chosen at once. Returns the number; 0: the write failed.
std::int64_t Reports::add(Report report, const Hold& hold, bool now, Time time,
                          std::span<const Report> before) {
  std::vector<ReportEvent> events;
  if (!hold.why.empty()) events.push_back(ReportEvent::Held);
  if (now) events.push_back(ReportEvent::Chosen);
  const auto edit = [&](Report& chosen) {
    if (chosen.state == ReportState::Sending) prepare(chosen, time);
    if (chosen.state == ReportState::Held) chosen.same_as = hold.same_as;
  };
  const std::int64_t number = book_.add(std::move(report), events, hold.why, edit, before);
  if (number == 0) return 0;
  clients_.on_posted(number, time.now);
  if (hold.for_undo) review_.await_undo(number, time);
  return number;
}

/// Queues the report, as if it was posted now. False: the write failed.
bool Reports::end_undo(std::int64_t number, const std::string& note, Time time) {
  if (!book_.move({number, ReportEvent::UndoOver, note}, time)) return false;
  review_.end_undo(number);
  clients_.on_posted(number, time.now);
  return true;
}

std::map<std::string, std::size_t> Reports::waiting_elsewhere() const {
  std::map<std::string, std::size_t> counts;
  for (const std::int64_t number : book_.waiting()) {
    const std::int64_t its = book_.at(number).run;
    if (!account_.runs().is_at(its, expected_run().post)) ++counts[account_.runs().find(its)->post];
  }
  return counts;
}

void Reports::on_status(const icd::RunStatus& status, Instant asked, Time time) {
  changes_.detect_change(status, time);
  account_.on_status(status, time);
  barred_ = is_page_ = false;  // the token and the address are right
  ordered_.clear();
  book_.move(doubts_.decide_by_status(status, asked, time), time);
  const std::int64_t open = doubts_.open_count();  // until this status
  doubts_.count(asked, time);
  if (!doubts_.has_open_group()) account_.settle(status, open, time);
}

void Reports::on_status_failed(NoStatus why, Time time) {
  if (why != NoStatus::NoAnswer) account_.on_dumb(time.now);
  is_page_ = why == NoStatus::Page;
  doubts_.on_failed(time);
}

void Reports::tick(Time time) {
  book_.catch_up();
  clients_.tick(time.now);
  if (clients_.is_stopping()) return;  // a restart leaves them held
  for (const std::int64_t number : review_.late_undos(time.now)) end_undo(number, "", time);
}

std::optional<Instant> Reports::next_deadline() const {
  const auto client = clients_.next_deadline();
  const auto undo = clients_.is_stopping() ? std::nullopt : review_.next_undo();
  return client && undo ? std::min(client, undo) : client ? client : undo;
}

namespace {

/// Unfinished reports at the Command Post that the settings name.
struct OpenReports {
  std::size_t waiting = 0, in_doubt = 0, held = 0;
  std::size_t all() const { return waiting + in_doubt + held; }
};

OpenReports open_here(const Reports& reports) {
  OpenReports open;
  for (const std::int64_t number : reports.book().open()) {
    const Report& report = reports.book().at(number);
    if (!reports.runs().is_at(report.run, reports.expected_run().post)) continue;
    open.waiting += report.state == ReportState::Queued ? 1 : 0;
    open.held += report.state == ReportState::Held ? 1 : 0;
    // A report in flight may still come into doubt.
    const bool unclear = report.state == ReportState::InDoubt || report.state == ReportState::Sending;
    open.in_doubt += unclear ? 1 : 0;
  }
  return open;
}

/// "2 reports are queued, 1 is in doubt"
std::string count_text(const OpenReports& open) {
  std::string text;
  const auto add = [&text](std::size_t count, const char* one, const char* many) {
    if (count == 0) return;
    const char* const what = text.empty() ? (count == 1 ? " report " : " reports ") : " ";
    text += icd::sentence(text.empty() ? "" : ", ", count, what, count == 1 ? one : many);
  };
  add(open.waiting, "is queued", "are queued");
  add(open.in_doubt, "is in doubt", "are in doubt");
  add(open.held, "is held", "are held");
  return text;
}

std::string describe_known_run(const Reports& reports, const std::string& post) {
  const Run* const known = reports.runs().latest_at(post);
  if (known == nullptr) return "";
  const auto count = std::ranges::count_if(
      reports.book().all(), [known](const auto& item) { return item.second.run == known->number; });
  return icd::sentence("; run ", known->number, " there continues, with ", count,
                       count == 1 ? " report" : " reports");
}

}  // namespace

std::string describe_command_post_change(const Reports& reports, const std::string& post) {
  const std::string& here = reports.expected_run().post;
  std::string text = "reports go to " + post + " from then on" + describe_known_run(reports, post);
  const OpenReports open = open_here(reports);
  if (open.all() == 0) return text + "; no report is queued, in doubt or held now";
  text += "; " + count_text(open);
  if (!reports.expected_run().was_heard()) {
    return text + ": the Command Post at " + here +
           " has not answered yet, so queued reports are sent to the first Command Post that answers";
  }
  const char* const kept =
      open.all() == 1 ? ": Adit keeps it for the run at " : ": Adit keeps them for the run at ";
  return text + kept + here + ", and sends them to the new Command Post only on request";
}

namespace {

constexpr const char* kLost = "its content is lost from the ledger; post it again, or settle it";
constexpr const char* kSent = "the operator sent it";
constexpr const char* kDisk = "the change could not be stored and was not made; try again";

std::unexpected<std::string> not_found(std::int64_t number) {
  return std::unexpected(icd::sentence("there is no report ", number));
}

std::unexpected<std::string> action_error(const Report& report, const std::string& what) {
  return std::unexpected(
      icd::sentence("report ", report.number, " is ", display_name(report.state), ": ", what));
}

}  // namespace

Reports::Outcome Reports::send(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return not_found(number);
  if (transition(report->state, ReportEvent::Released) == nullptr) {
    return action_error(*report, "to send it again, resubmit it");
  }
  if (report->is_lost()) return action_error(*report, kLost);
  if (review_.awaits_undo(number)) {
    return end_undo(number, kSent, time) ? Outcome(number) : std::unexpected(kDisk);
  }
  const bool decided = report->state == ReportState::InDoubt;
  const Report* const other = decided ? review_.answered_later(*report) : review_.find_duplicate(*report);
  if (other != nullptr) {
    return action_error(
        *report, icd::sentence("report ", other->number, " is the same and is ", display_name(other->state),
                               " in this run; to send it again, resubmit that report"));
  }
  if (decided && !doubts_.blur(number, time)) return std::unexpected(kDisk);
  const bool moved = book_.move({number, ReportEvent::Released, kSent,
                                 [&](Report& sent) {
                                   sent.asked = true;
                                   sent.same_as = 0;
                                   sent.tries = 0;
                                   sent.run = expected_run().number;
                                 }},
                                time);
  if (!moved) return std::unexpected(kDisk);
  ordered_.insert(number);
  if (decided) doubts_.ask_for_others(time);
  return number;
}

Reports::Outcome Reports::hold(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return not_found(number);
  const bool waits = review_.awaits_undo(number);
  const ReportEvent event = waits ? ReportEvent::Held : ReportEvent::HeldBack;
  if (transition(report->state, event) == nullptr || (report->state == ReportState::Held && !waits)) {
    return action_error(*report, report->state == ReportState::Held ? "it is held already"
                                 : is_final(report->state)          ? "only a queued report can be held"
                                                                    : "it may have been sent already");
  }
  if (!book_.move({number, event, "the operator held it"}, time)) return std::unexpected(kDisk);
  review_.on_decided(number);
  return number;
}

Reports::Outcome Reports::withdraw(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return not_found(number);
  if (transition(report->state, ReportEvent::Withdrawn) == nullptr) {
    return action_error(*report, is_final(report->state) ? "it is finished and cannot be withdrawn"
                                 : report->state == ReportState::Sending
                                     ? "its sending has begun, so it cannot be undone"
                                     : "it may have been recorded; send it, or settle it");
  }
  const char* const why = review_.awaits_undo(number) ? "the operator undid it" : "";
  if (!book_.move({number, ReportEvent::Withdrawn, why}, time)) return std::unexpected(kDisk);
  review_.on_decided(number);
  return number;
}

Reports::Outcome Reports::settle(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return not_found(number);
  if (transition(report->state, ReportEvent::Settled) == nullptr) {
    return action_error(*report, "only a report in doubt can be settled");
  }
  const bool done = doubts_.blur(number, time) &&
                    book_.move({number, ReportEvent::Settled, "the operator settled it"}, time);
  if (!done) return std::unexpected(kDisk);
  doubts_.ask_for_others(time);
  return number;
}

Reports::Outcome Reports::correct(std::int64_t number, const icd::ArtifactReport& to, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return not_found(number);
  const ReportTransition* const row = transition(report->state, ReportEvent::Corrected);
  if (row == nullptr) return action_error(*report, "only a held report can be corrected");
  if (is_same(report->report, to))
    return action_error(*report, "the correction is the same report; send it instead");
  Report next{.number = book_.next_number(),
              .report = to,
              .sender = "operator",
              .received = time.stamp,
              .changed = time.stamp,
              .note = icd::sentence("corrects report ", number, ", ", describe(report->report)),
              .run = expected_run().number,
              .asked = true};
  if (!next.report.robot) next.report.robot = report->report.robot;
  if (const Report* const other = review_.find_duplicate(next); other != nullptr) {
    return action_error(*report,
                        icd::sentence("report ", other->number, " is the same as the correction and is ",
                                      display_name(other->state), " in this run"));
  }
  Report corrected = *report;
  corrected.state = row->to;
  corrected.changed = time.stamp;
  corrected.note = icd::sentence("the operator corrected it: report ", next.number, ", ", describe(to));
  corrected.run = next.run;
  corrected.same_as = next.number;
  const std::int64_t made = add(std::move(next), review_.hold_for_undo(), false, time, {&corrected, 1});
  if (made == 0) return std::unexpected(kDisk);
  clients_.hand_over(number, book_.at(made));
  review_.on_decided(number);
  return made;
}

Reports::Outcome Reports::resubmit(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return not_found(number);
  if (!is_final(report->state)) return action_error(*report, "it is not finished yet");
  if (report->is_lost()) return action_error(*report, kLost);
  for (const Report* const other : review_.same_in_run(report->report)) {
    if (other->asked && !is_final(other->state)) return other->number;  // pressed twice, sent once
  }
  Report again{.report = report->report, .sender = "operator", .received = time.stamp, .changed = time.stamp};
  again.note = icd::sentence("report ", number, " again");
  again.run = expected_run().number;
  again.asked = true;
  const std::int64_t made = add(std::move(again), {}, false, time);
  return made != 0 ? Outcome(made) : std::unexpected(kDisk);
}

}  // namespace adit::dispatch
