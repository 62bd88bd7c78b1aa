#include "dispatch/reports.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "icd/require.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {

Reports::Reports(const ReportRules& rules, Output& output)
    : rules_(rules),
      output_(output),
      book_(output,
            [this](std::int64_t number, ReportAction action, Time time) { follow(number, action, time); }),
      account_(book_),
      review_(rules_, book_, account_),
      doubts_(rules_.policy, book_, account_, review_),
      clients_(book_, account_, output),
      changes_(rules_.policy, book_, account_, review_, doubts_, clients_),
      sender_(book_, account_, review_, doubts_, clients_, changes_) {}

void Reports::open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post) {
  book_.open(std::move(all));
  begin(std::move(runs), time, post);
}

void Reports::carry_on(Reports& before, Time time, const std::string& post) {
  icd::require(before.sending() == nullptr);
  clients_.carry_on(before.clients_);  // first, so that begin() can answer them
  book_.carry_on(before.book_);
  const auto runs = before.runs().all() | std::views::values;
  begin({runs.begin(), runs.end()}, time, post);
}

void Reports::begin(std::vector<Run> runs, Time time, const std::string& post) {
  std::int64_t latest_run = 1;
  for (const auto& [number, report] : book_.all()) latest_run = std::max(latest_run, report.run);
  account_.open(std::move(runs), latest_run, post);
  sender_.open(time);
  for (const std::int64_t number : book_.waiting()) review_.compare_later(number);
  doubts_.open();
  doubts_.begin(time.now);
  if (!post.empty() && run().post != post) changes_.change_post(post, time);
}

void Reports::follow(std::int64_t number, ReportAction action, Time time) {
  switch (action) {
    case ReportAction::Nothing:
    case ReportAction::Send:  // by the caller
      break;
    case ReportAction::AnswerClients:
    case ReportAction::TellClients:
      clients_.tell_all(number);
      break;
    case ReportAction::Ask:
      doubts_.lost(number, time.now);
      break;
  }
}

bool Reports::take(const PostedReport& posted, ClientId client, bool may_send, Time time) {
  Report report{
      .report = posted.report, .sender = posted.sender, .received = time.stamp, .changed = time.stamp};
  report.run = meant_run().number;
  report.asked = posted.resubmit;
  const bool fresh = is_fresh(time.now);
  const Report* const same = review_.earlier(report);
  // A finished report's run may have ended unnoticed: ReportSender compares later.
  const bool repeats = same != nullptr && (fresh || !is_final(same->state));
  if (repeats && (!report.asked || (same->asked && !is_final(same->state)))) {
    if (is_final(same->state)) {
      clients_.tell(client, *same);
    } else {
      clients_.posted(same->number, time.now);
      clients_.add(client, same->number, time.now + rules_.answer_within);
    }
    return false;
  }
  if (account_.waiting_at(meant_run().post).size() >= rules_.most_waiting) {
    output_.tell(client,
                 {.status = icd::Status::TooManyRequests,
                  .sentence = icd::sentence(rules_.most_waiting,
                                            " reports are queued already; this report was not accepted")},
                 report);
    return false;
  }
  Hold hold = fresh ? review_.reason_to_hold(report) : Hold{};
  if (posted.can_be_undone && hold.why.empty()) hold = review_.hold_for_undo();
  if (const Report* const other = review_.sent_to_other_command_post(report); other != nullptr) {
    report.note = icd::sentence("the same as report ", other->number,
                                ", which was sent to another Command Post; queued until the Command Post at ",
                                run().post, " answers");
  }
  return take_new(std::move(report), hold, client, may_send, time);
}

bool Reports::take_new(Report report, const Hold& hold, ClientId client, bool may_send, Time time) {
  const bool fresh = is_fresh(time.now);
  // Accepting and choosing in one write flush the disk once.
  const bool now = may_send && hold.why.empty() && fresh && sender_.may_go_first(report, time.now);
  const std::int64_t number = add(report, hold, now, time);
  if (number == 0) {
    output_.tell(client, {.sentence = "the report could not be stored and was not accepted; post it again"},
                 report);
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
    if (chosen.state == ReportState::Sending) sender_.prepare(chosen, time);
    if (chosen.state == ReportState::Held) chosen.same_as = hold.same_as;
  };
  const std::int64_t number = book_.add(std::move(report), events, hold.why, edit, before);
  if (number == 0) return 0;
  clients_.posted(number, time.now);
  if (hold.for_undo) review_.await_undo(number, time);
  return number;
}

/// Queues the report, as if it was posted now. False: the write failed.
bool Reports::end_undo(std::int64_t number, const std::string& note, Time time) {
  if (!book_.move({number, ReportEvent::UndoOver, note}, time)) return false;
  review_.undo_over(number);
  clients_.posted(number, time.now);
  return true;
}

std::map<std::string, std::size_t> Reports::waiting_elsewhere() const {
  std::map<std::string, std::size_t> counts;
  for (const std::int64_t number : book_.waiting()) {
    const std::int64_t its = book_.at(number).run;
    if (!account_.runs().is_at(its, meant_run().post)) ++counts[account_.runs().find(its)->post];
  }
  return counts;
}

void Reports::status_heard(const icd::RunStatus& status, Instant asked, Time time) {
  changes_.meet(status, time);
  account_.heard(status, time);
  sender_.status_heard();
  book_.move(doubts_.hear(status, asked, time), time);
  const std::int64_t open = doubts_.open_count();  // until this status
  doubts_.count(asked, time);
  if (!doubts_.has_open_group()) account_.settle(status, open, time);
}

void Reports::status_failed(NoStatus why, Time time) {
  if (why != NoStatus::NoAnswer) account_.dumb(time.now);
  sender_.status_failed(why);
  doubts_.failed(time);
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

}  // namespace adit::dispatch
