#include "dispatch/doubts.hpp"

#include "codec/write.hpp"
#include "dispatch/reconciled_answer.hpp"
#include "dispatch/report_verdict.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// Empty if the run's status can decide.
std::string undecidable(const Report& report, const Run& run, const Run* its) {
  if (its != nullptr && !its->post.empty() && its->post != run.post) {
    return "it was sent to the Command Post at " + its->post +
           ", which Adit asks again when the settings name it again";
  }
  if (report.run != run.number) return "a new run began before the status showed whether it was recorded";
  if (!run.unreliable.empty()) return run.unreliable;
  if (!report.before && report.sent < run.began) {
    return "a new run began just after it was sent, so that it may have been recorded in either run";
  }
  if (!report.before) {
    return report.uncertain.empty() ? "the Command Post's counts before it was sent are not certain"
                                    : report.uncertain;
  }
  return "";
}

SentSince sent_since(const Report& doubt, const ReportBook& book) {
  SentSince since;
  for (const auto& [number, report] : book.all()) {
    if (report.run != doubt.run || report.sending <= doubt.sending) continue;
    const Effect effect = effect_of(report);
    since.scored += effect.scored ? 1 : 0;
    since.points += effect.points;
  }
  return since;
}

constexpr const char* kOperator = "; the operator decides: send it, or settle it";

}  // namespace

bool Doubts::is_asking(const Report& report) const {
  return inquiry_ && !inquiry_->is_in_vain() && report.state == ReportState::InDoubt &&
         report.run == account_.run().number;
}

std::optional<Instant> Doubts::next_ask(Instant now) const {
  return inquiry_ ? std::optional(inquiry_->next_ask(now)) : std::nullopt;
}

void Doubts::begin(Instant now) {
  inquiry_.reset();
  const Run& run = account_.run();
  const auto doubts = all();
  if (!doubts.empty() && undecidable(*doubts.front(), run, &run).empty()) inquiry_.emplace(policy_, now);
}

void Doubts::lost(Instant now) {
  account_.lose();
  begin(now);
}

void Doubts::failed(Time time) {
  if (!inquiry_) return;
  inquiry_->asked(time.now);
  inquiry_->failed(time.now);
  if (inquiry_->is_in_vain()) explain(all(), "the Command Post does not answer with the run's status", time);
}

std::vector<ReportBook::Step> Doubts::hear(const icd::RunStatus& status, Instant asked, Time time) {
  const auto doubts = all();
  if (inquiry_) inquiry_->asked(time.now);
  Evidence evidence;
  if (inquiry_ && !doubts.empty()) {
    const Report& first = *doubts.front();
    evidence =
        weigh(*first.before, static_cast<std::int64_t>(doubts.size()), sent_since(first, book_), status);
    evidence.finding = inquiry_->hear(evidence, status.run_clock, asked, time.now);
  }
  std::vector<ReportBook::Step> steps;
  switch (evidence.finding) {
    case Finding::Recorded:
      for (const Report* const doubt : doubts) steps.push_back(found(*doubt, evidence));
      break;
    case Finding::NotRecorded:
      for (const Report* const doubt : doubts) steps.push_back(missing(*doubt, evidence));
      break;
    case Finding::Contradicts:
      account_.distrust(evidence.why, time.stamp);
      inquiry_.reset();
      explain(doubts, "", time);
      break;
    case Finding::Silent:
      explain(doubts, evidence.why, time);
      break;
  }
  return steps;
}

ReportBook::Step Doubts::found(const Report& doubt, const Evidence& evidence) const {
  const auto edit = [this, evidence](Report& report) {
    report.status = static_cast<int>(icd::Status::Created);
    report.content_type = codec::kJson;
    report.answer = reconciled_answer(report, account_.run(), evidence.points_each, evidence.why);
    report.reconciled = true;
  };
  return {doubt.number, ReportEvent::Found, "found recorded: " + evidence.why, edit};
}

/// The operator may have sent the same report since. Then this one is held.
ReportBook::Step Doubts::missing(const Report& doubt, const Evidence& evidence) const {
  const Report* const same = doubt.asked ? nullptr : review_.twin(doubt);
  if (same != nullptr) {
    return {.number = doubt.number,
            .event = ReportEvent::Held,
            .note = icd::sentence("not recorded, and report ", same->number, " is the same and is ",
                                  shown_name_of(same->state), " in this run")};
  }
  if (doubt.tries >= kMostTries) {
    return {.number = doubt.number,
            .event = ReportEvent::Held,
            .note = icd::sentence("sent ", doubt.tries, " times without an answer, and not recorded")};
  }
  return {.number = doubt.number, .event = ReportEvent::Missing, .note = "not recorded: " + evidence.why};
}

void Doubts::explain(const Reports& doubts, const std::string& seen, Time time) {
  std::vector<Report> noted;
  for (const Report* const doubt : doubts) {
    if (doubt->is_lost()) continue;  // its note is complete
    const Report& first = *doubts.front();
    const std::string why = undecidable(first, account_.run(), account_.runs().find(first.run));
    const std::string note =
        is_asking(*doubt) ? "asking for the run's status: " + seen : (why.empty() ? seen : why) + kOperator;
    if (doubt->note == note) continue;
    Report& report = noted.emplace_back(*doubt);
    report.note = note;
    report.changed = time.stamp;
  }
  book_.note(noted);
}

bool Doubts::blur(std::int64_t decided, Time time) {
  const std::int64_t its_run = book_.at(decided).run;
  std::vector<Report> blurred;
  for (const Report* const doubt : book_.doubts(its_run)) {
    if (doubt->number != decided && doubt->before) blurred.emplace_back(*doubt).before.reset();
  }
  if (!book_.note(blurred)) return false;
  if (its_run != account_.run().number) return true;  // no inquiry there
  account_.lose(time.now + policy_.doubt_for);
  begin(time.now);
  return true;
}

void Doubts::leave_to_operator(const std::string& why, Time time) {
  std::vector<Report> left;
  for (const Report* const doubt : all()) {
    if (!doubt->uncertain.empty()) continue;
    Report& report = left.emplace_back(*doubt);
    report.before.reset();
    report.uncertain = why;
    report.changed = time.stamp;
  }
  if (!left.empty()) book_.change(left, account_.run());
  begin(time.now);
  explain(all(), "", time);
}

void Doubts::ask_for_others(Time time) {
  begin(time.now);
  explain(all(), "", time);
}

}  // namespace adit::dispatch
