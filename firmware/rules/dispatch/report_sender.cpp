#include "dispatch/report_sender.hpp"

#include <algorithm>

#include "codec/read.hpp"
#include "dispatch/report.hpp"
#include "dispatch/verdicts.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {

void ReportSender::open(Time time) {
  for (const auto& [number, report] : book_.all()) {
    last_sending_ = std::max(last_sending_, report.sending);
  }
  while (book_.sending() != nullptr) {
    ended(ReportEvent::Restarted, "aditd stopped while it was in flight", time);
  }
}

/// The report is certainly meant for the present run. If no status comes, a young one or one sent on purpose
/// may go.
bool ReportSender::may_go(const Report& report, Instant now) const {
  if (barred_ || (is_page_ && !ordered_.contains(report.number))) return false;
  if (doubts_.is_pending(now)) return false;
  if (account_.is_fresh(now)) return true;
  if (!account_.is_dumb(now) || review_.sent_to_other_command_post(report) != nullptr) return false;
  return report.asked || clients_.is_young(report, now);
}

bool ReportSender::may_go_first(const Report& report, Instant now) const {
  return book_.sending() == nullptr && account_.waiting_here().empty() && may_go(report, now);
}

std::optional<std::int64_t> ReportSender::next(Instant now) const {
  for (const std::int64_t number : account_.waiting_here()) {
    if (may_go(book_.at(number), now)) return number;
  }
  return std::nullopt;
}

NextRequests ReportSender::next_requests(Time time) const {
  if (book_.sending() != nullptr) return {};
  NextRequests requests;
  requests.status = doubts_.next_ask(time.now);
  requests.in_doubt = requests.status.has_value();
  if (account_.waiting_here().empty()) return requests;
  requests.report = next(time.now).has_value();
  if (barred_ || is_page_ || !account_.is_fresh(time.now)) requests.status = time.now;
  return requests;
}

/// The comparison that Reports::take() left out because the run was unknown. False: do not send it now.
bool ReportSender::check(std::int64_t number, Time time) {
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
      review_.compared(number);
      clients_.hand_over(number, book_.at(original));
    }
    return false;
  }
  if (const Hold hold = review_.reason_to_hold(report); !hold.why.empty()) {
    const auto keep = [&hold](Report& held) { held.same_as = hold.same_as; };
    if (book_.move({number, ReportEvent::Held, hold.why, keep}, time)) review_.compared(number);
    return false;
  }
  review_.compared(number);
  return true;
}

const Report* ReportSender::choose(Time time) {
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

void ReportSender::prepare(Report& report, Time time) {
  report.run = account_.run().number;
  report.sending = ++last_sending_;
  report.sent = time.stamp;
  report.before = doubts_.has_open_group() ? std::nullopt : account_.expected(time.now);
  report.beside = report.before ? doubts_.open_count() : 0;
  report.counted = false;
  report.uncertain.clear();
  report.status = 0;
  report.content_type.clear();
  report.answer.clear();
}

/// For the report in flight. A new run may have begun meanwhile: either may have recorded it.
void ReportSender::ended(ReportEvent event, const std::string& note, Time time,
                         const ReportBook::Edit& edit) {
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

ReportEvent ReportSender::answered(const HttpAnswer& answer, Time time) {
  const auto reply = codec::read_report_reply(answer.body);
  const Report* const another = reply ? told_of_another(*reply) : nullptr;
  const ReportEvent event = event_of(answer.status, reply && another == nullptr,
                                     reply ? Body::Json : body_of(answer.body), answer.is_unprocessed);
  const auto keep = [&](Report& report) {
    report.status = answer.status;
    report.content_type = answer.content_type;
    report.answer = answer.body;
  };
  barred_ = event == ReportEvent::Barred;
  if (event == ReportEvent::Recorded) {
    recorded(keep, *reply, time);
  } else {
    const std::string note =
        another != nullptr && event == ReportEvent::Lost
            ? icd::sentence("the answer is for report ", another->number, ", not for this report")
            : answer_text(answer.status, answer.body);
    ended(event, note, time, keep);
  }
  return event;
}

/// The other sent report in `reply`, or null. Servers and proxies may repeat an answer, which is no evidence
/// here.
const Report* ReportSender::told_of_another(const icd::ReportReply& reply) const {
  if (!reply.report || is_same(*reply.report, book_.sending()->report)) return nullptr;
  for (const Report* const other : book_.same_as(*reply.report)) {
    if (other->number != book_.sending()->number && other->sending != 0) return other;
  }
  return nullptr;
}

void ReportSender::recorded(const ReportBook::Edit& keep, const icd::ReportReply& reply, Time time) {
  changes_.meet(reply, time);  // the answer decides the run
  const Effect effect = effect_of(reply);
  const bool is_strange = is_about_another(reply, book_.sending()->report);
  std::string note;
  if (effect.again) {
    note = "not scored (" + reply.report_status + "); post it again when the run continues";
  } else if (reply.report && !is_same(*reply.report, book_.sending()->report)) {
    note = "the answer is for " + described(*reply.report);
  }
  ended(ReportEvent::Recorded, note, time, [&](Report& report) {
    keep(report);
    report.run = account_.run().number;
  });
  account_.answered(reply, time);
  if (is_strange) account_.lose();
}

}  // namespace adit::dispatch
