// Reports whose answer was lost.
#include "codec/write.hpp"
#include "dispatch/reconciled_answer.hpp"
#include "dispatch/report_verdict.hpp"
#include "dispatch/reports.hpp"
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
  if (!report.before) return "the Command Post's counts before it was sent are not certain";
  return "";
}

constexpr const char* kOperator = "; the operator decides: send it, or settle it";

}  // namespace

bool Reports::is_asking(const Report& report) const {
  return inquiry_ && !inquiry_->is_in_vain() && report.state == ReportState::InDoubt &&
         report.run == run().number;
}

/// The inquiry covers older doubts.
void Reports::doubt_began(Instant now) {
  inquiry_.reset();
  const auto doubts = book_.doubts(run().number);
  if (!doubts.empty() && undecidable(*doubts.front(), run(), &run()).empty()) {
    inquiry_.emplace(rules_.policy, now);
  }
}

SentSince Reports::sent_since(const Report& doubt) const {
  SentSince since;
  for (const auto& [number, report] : book_.all()) {
    if (report.run != doubt.run || report.sending <= doubt.sending) continue;
    const Effect effect = effect_of(report);
    since.scored += effect.scored ? 1 : 0;
    since.points += effect.points;
  }
  return since;
}

void Reports::status_heard(const icd::RunStatus& status, Instant asked, Time time) {
  if (const auto another = account_.another(status, time)) meet(*another, status, time);
  account_.heard(status, time);
  barred_ = false;
  if (inquiry_) inquiry_->asked(time.now);
  if (book_.doubts(run().number).empty()) {
    account_.settle(status, time);
  } else {
    inquire(status, asked, time);
  }
}

void Reports::status_failed(bool reached, Time time) {
  if (reached) account_.dumb(time.now);
  if (!inquiry_) return;
  inquiry_->asked(time.now);
  inquiry_->failed(time.now);
  if (inquiry_->is_in_vain())
    explain(book_.doubts(run().number), "the Command Post does not answer with the run's status", time);
}

void Reports::inquire(const icd::RunStatus& status, Instant asked, Time time) {
  const auto doubts = book_.doubts(run().number);
  if (!inquiry_) return explain(doubts, "", time);
  const Report& first = *doubts.front();
  const Evidence evidence =
      weigh(*first.before, static_cast<std::int64_t>(doubts.size()), sent_since(first), status);
  switch (inquiry_->hear(evidence, status.run_clock, asked, time.now)) {
    case Finding::Recorded:
      settle(doubts, evidence, time);
      break;
    case Finding::NotRecorded:
      send_again(doubts, evidence, time);
      break;
    case Finding::Contradicts:
      account_.distrust(evidence.why, time.stamp);
      inquiry_.reset();
      return explain(doubts, "", time);
    case Finding::Silent:
      return explain(doubts, evidence.why, time);
  }
  if (!book_.doubts(run().number).empty()) return;  // the disk write failed: ask again
  inquiry_.reset();
  account_.settle(status, time);
}

void Reports::settle(const std::vector<const Report*>& doubts, const Evidence& evidence, Time time) {
  std::vector<ReportBook::Step> steps;
  for (const Report* const doubt : doubts) {
    const auto found = [&](Report& report) {
      report.status = static_cast<int>(icd::Status::Created);
      report.content_type = codec::kJson;
      report.answer = reconciled_answer(report, run(), evidence.points_each, evidence.why);
      report.reconciled = true;
    };
    steps.push_back({doubt->number, ReportEvent::Found, "found recorded: " + evidence.why, found});
  }
  take_steps(steps, time);
}

/// The operator may have sent the same report since. Then this one is held.
ReportBook::Step Reports::after_loss(const Report& doubt, const Evidence& evidence) const {
  const Report* const same = doubt.asked ? nullptr : twin(doubt);
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

void Reports::send_again(const std::vector<const Report*>& doubts, const Evidence& evidence, Time time) {
  std::vector<ReportBook::Step> steps;
  steps.reserve(doubts.size());
  for (const Report* const doubt : doubts) steps.push_back(after_loss(*doubt, evidence));
  take_steps(steps, time);
}

/// Notes the state of the inquiry.
void Reports::explain(const std::vector<const Report*>& doubts, const std::string& seen, Time time) {
  std::vector<Report> noted;
  for (const Report* const doubt : doubts) {
    if (doubt->is_lost()) continue;  // its note is complete
    const Report& first = *doubts.front();
    const std::string why = undecidable(first, run(), account_.runs().find(first.run));
    const std::string note =
        is_asking(*doubt) ? "asking for the run's status: " + seen : (why.empty() ? seen : why) + kOperator;
    if (doubt->note == note) continue;
    Report& report = noted.emplace_back(*doubt);
    report.note = note;
    report.changed = time.stamp;
  }
  book_.note(noted);
}

/// Forgets the expected counts of other doubts, which no longer show the result. Call it before the
/// operator's decision is written, so that a power cut between leaves no wrong evidence. False: the write
/// failed.
bool Reports::blur_doubts(std::int64_t decided, Time time) {
  const std::int64_t its_run = book_.at(decided).run;
  std::vector<Report> blurred;
  for (const Report* const doubt : book_.doubts(its_run)) {
    if (doubt->number != decided && doubt->before) blurred.emplace_back(*doubt).before.reset();
  }
  if (!book_.note(blurred)) return false;
  if (its_run != run().number) return true;  // no inquiry there
  account_.lose(time.now + rules_.policy.doubt_for);
  doubt_began(time.now);
  return true;
}

/// After the operator's decision.
void Reports::ask_for_others(Time time) {
  doubt_began(time.now);
  explain(book_.doubts(run().number), "", time);
}

}  // namespace adit::dispatch
