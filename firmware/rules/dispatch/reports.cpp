// Reports towards the Command Post: choosing, sending, answers.
#include "dispatch/reports.hpp"

#include <algorithm>
#include <utility>

#include "codec/read.hpp"
#include "dispatch/report_verdict.hpp"
#include "dispatch/said.hpp"
#include "dispatch/same_report.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

constexpr std::chrono::seconds kRetryWrite{1};  // after a failed write

}  // namespace

Reports::Reports(const ReportRules& rules, Output& output)
    : rules_(rules), book_(output), account_(book_), output_(output) {}

void Reports::open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post) {
  book_.open(std::move(all));
  std::int64_t latest_run = 1;
  std::vector<std::int64_t> sending;
  for (const auto& [number, report] : book_.all()) {
    last_sending_ = std::max(last_sending_, report.sending);
    latest_run = std::max(latest_run, report.run);
    if (report.state == ReportState::Sending) sending.push_back(number);
  }
  account_.open(std::move(runs), latest_run, post);
  for (const std::int64_t number : sending) {
    step(number, ReportEvent::Restarted, "aditd stopped while it was in flight", time,
         [this](Report& report) {
           ++report.tries;
           enter_run(report);
         });
  }
  unchecked_.insert(book_.waiting().begin(), book_.waiting().end());
  doubt_began(time.now);
  if (!post.empty() && run().post != post) change_post(post, time);
}

void Reports::open(std::vector<Report> all, std::vector<Run> runs, Time time, const std::string& post,
                   Reports& before) {
  icd::require(before.sending() == nullptr);
  clients_ = std::exchange(before.clients_, {});  // first, so that open() can answer them
  taken_at_ = std::exchange(before.taken_at_, {});
  open(std::move(all), std::move(runs), time, post);
}

/// Applies an event and then its action. False: not on disk, not applied.
bool Reports::step(std::int64_t number, ReportEvent event, const std::string& note, Time time,
                   const ReportBook::Edit& edit) {
  const ReportBook::Step one{number, event, note, edit};
  return take_steps({&one, 1}, time);
}

/// All or none.
bool Reports::take_steps(std::span<const ReportBook::Step> steps, Time time) {
  std::vector<ReportAction> actions;
  for (const ReportBook::Step& one : steps) {
    const ReportTransition* const row = transition(book_.at(one.number).state, one.event);
    if (row == nullptr) return false;
    actions.push_back(row->action);
  }
  if (!book_.move(steps, time.stamp)) return false;
  for (std::size_t i = 0; i < steps.size(); ++i) follow(steps[i].number, actions[i], time);
  return true;
}

void Reports::follow(std::int64_t number, ReportAction action, Time time) {
  switch (action) {
    case ReportAction::Nothing:
      break;
    case ReportAction::Send:
      sending_ = number;
      break;
    case ReportAction::AnswerClients:
    case ReportAction::TellClients:
      for (const ClientId client : clients_.take(number)) tell_how_it_stands(client, book_.at(number));
      break;
    case ReportAction::Ask:
      account_.lose();
      doubt_began(time.now);
      break;
  }
}

bool Reports::is_young(const Report& report, Instant now) const {
  const auto taken = taken_at_.find(report.number);
  return taken != taken_at_.end() && now - taken->second < kYoung;
}

/// The report is certainly meant for the present run. If no status comes, a young one or one sent on purpose
/// may go.
bool Reports::may_go(const Report& report, Instant now) const {
  if (barred_) return false;
  if (inquiry_ && inquiry_->is_pending(now)) return false;
  if (account_.is_fresh(now)) return true;
  if (!account_.is_dumb(now) || sent_to_another_post(report) != nullptr) return false;
  return report.asked || is_young(report, now);
}

std::vector<std::int64_t> Reports::waiting_here() const {
  return waiting_at(run().post);
}

std::vector<std::int64_t> Reports::waiting_at(const std::string& post) const {
  std::vector<std::int64_t> there;
  for (const std::int64_t number : book_.waiting()) {
    if (account_.runs().is_at(book_.at(number).run, post)) there.push_back(number);
  }
  return there;
}

std::map<std::string, std::size_t> Reports::waiting_elsewhere() const {
  std::map<std::string, std::size_t> counts;
  for (const std::int64_t number : book_.waiting()) {
    const std::int64_t its = book_.at(number).run;
    if (!account_.runs().is_at(its, meant_run().post)) ++counts[account_.runs().find(its)->post];
  }
  return counts;
}

std::optional<std::int64_t> Reports::next(Instant now) const {
  for (const std::int64_t number : waiting_here()) {
    if (may_go(book_.at(number), now)) return number;
  }
  return std::nullopt;
}

Wish Reports::wish(Time time) const {
  if (sending_) return {};
  Wish wish;
  if (inquiry_) wish.status = inquiry_->next_ask(time.now);
  wish.in_doubt = wish.status.has_value();
  if (waiting_here().empty()) return wish;
  wish.report = next(time.now).has_value();
  if (barred_ || !account_.is_fresh(time.now)) wish.status = time.now;
  return wish;
}

const Report* Reports::choose(Time time) {
  while (const auto number = next(time.now)) {
    if (check(*number, time)) {
      const bool chosen =
          step(*number, ReportEvent::Chosen, "", time, [&](Report& report) { prepare(report, time); });
      return chosen ? &book_.at(*number) : nullptr;
    }
    if (book_.at(*number).state == ReportState::Queued) return nullptr;  // the write failed
  }
  return nullptr;
}

/// Fields that decide a doubt. Written before the bytes leave, they survive a crash.
void Reports::prepare(Report& report, Time time) {
  report.run = run().number;
  report.sending = ++last_sending_;
  report.sent = time.stamp;
  report.before = book_.doubts(run().number).empty() ? account_.expected(time.now) : std::nullopt;
  report.status = 0;
  report.content_type.clear();
  report.answer.clear();
}

/// For the report in flight.
void Reports::ended(ReportEvent event, const std::string& note, Time time, const ReportBook::Edit& edit) {
  const std::int64_t number = *std::exchange(sending_, std::nullopt);
  step(number, event, note, time, [&](Report& report) {
    if (event == ReportEvent::Lost) ++report.tries;
    if (edit) edit(report);
    if (event == ReportEvent::Lost || is_young(report, time.now)) enter_run(report);
  });
}

/// A new run began while it was in flight: either may have recorded it.
void Reports::enter_run(Report& report) const {
  if (report.run == run().number) return;
  report.run = run().number;
  report.before.reset();
}

ReportEvent Reports::answered(const HttpAnswer& answer, Time time) {
  const auto reply = codec::read_report_reply(answer.body);
  const Report* const another = reply ? told_of_another(*reply) : nullptr;
  const ReportEvent event =
      event_of(answer.status, reply && another == nullptr, reply ? Body::Json : body_of(answer.body));
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
            : said(answer.status, answer.body);
    ended(event, note, time, keep);
  }
  return event;
}

/// The other sent report in `reply`, or null. Servers and proxies may repeat an answer, which is no evidence
/// here.
const Report* Reports::told_of_another(const icd::ReportReply& reply) const {
  if (!reply.report || is_same(*reply.report, sending()->report)) return nullptr;
  for (const Report* const other : book_.same_as(*reply.report)) {
    if (other->number != *sending_ && other->sending != 0) return other;
  }
  return nullptr;
}

void Reports::recorded(const ReportBook::Edit& keep, const icd::ReportReply& reply, Time time) {
  meet(reply, time);  // the answer decides the run
  const Effect effect = effect_of(reply);
  std::string note;
  if (effect.again) {
    note = "not scored (" + reply.report_status + "); post it again when the run continues";
  } else if (reply.report && !is_same(*reply.report, sending()->report)) {
    note = "the answer is for " + described(*reply.report);
  }
  ended(ReportEvent::Recorded, note, time, [&](Report& report) {
    keep(report);
    report.run = run().number;
  });
  account_.answered(reply, time);
}

void Reports::never_left(const std::string& why, Time time) {
  ended(ReportEvent::NeverLeft, why, time);
}

void Reports::lost(const std::string& why, Time time) {
  ended(ReportEvent::Lost, why, time);
}

void Reports::tick(Time time) {
  book_.catch_up();
  for (const auto& [client, number] : clients_.take_late(time.now)) {
    tell_how_it_stands(client, book_.at(number));
  }
  std::erase_if(taken_at_, [&](const auto& item) { return time.now - item.second > kYoung; });
  if (stopping_) return;  // a restart leaves them held
  std::vector<std::int64_t> over;
  for (auto& [number, undo] : undo_) {
    if (undo.until > time.now) continue;
    over.push_back(number);
    undo.until = time.now + kRetryWrite;
  }
  for (const std::int64_t number : over) end_undo(number, "", time);
}

std::optional<Reports::Instant> Reports::next_deadline() const {
  std::optional<Instant> first = clients_.next_deadline();
  for (const auto& [number, undo] : undo_) {
    if (!stopping_) first = std::min(first.value_or(undo.until), undo.until);
  }
  return first;
}

}  // namespace adit::dispatch
