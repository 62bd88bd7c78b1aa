// The operator's actions on a report.
#include "dispatch/reports.hpp"
#include "dispatch/same_report.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

constexpr const char* kLost = "its content is lost from the ledger; post it again, or settle it";
constexpr const char* kSent = "the operator sent it";
constexpr const char* kDisk = "the change could not be stored and was not made; try again";

std::unexpected<std::string> no_such(std::int64_t number) {
  return std::unexpected(icd::sentence("there is no report ", number));
}

std::unexpected<std::string> cannot(const Report& report, const std::string& what) {
  return std::unexpected(
      icd::sentence("report ", report.number, " is ", shown_name_of(report.state), ": ", what));
}

}  // namespace

Reports::Outcome Reports::send(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return no_such(number);
  if (transition(report->state, ReportEvent::Released) == nullptr) {
    return cannot(*report, "to send it again, resubmit it");
  }
  if (report->is_lost()) return cannot(*report, kLost);
  if (review_.awaits_undo(number)) {
    return end_undo(number, kSent, time) ? Outcome(number) : std::unexpected(kDisk);
  }
  const bool decided = report->state == ReportState::InDoubt;
  const Report* const other = decided ? review_.answered_later(*report) : review_.twin(*report);
  if (other != nullptr) {
    return cannot(*report,
                  icd::sentence("report ", other->number, " is the same and is ", shown_name_of(other->state),
                                " in this run; to send it again, resubmit that report"));
  }
  if (decided && !doubts_.blur(number, time)) return std::unexpected(kDisk);
  const bool moved = book_.move({number, ReportEvent::Released, kSent,
                                 [&](Report& sent) {
                                   sent.asked = true;
                                   sent.same_as = 0;
                                   sent.tries = 0;
                                   sent.run = meant_run().number;
                                 }},
                                time);
  if (!moved) return std::unexpected(kDisk);
  sender_.order(number);
  if (decided) doubts_.ask_for_others(time);
  return number;
}

Reports::Outcome Reports::hold(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return no_such(number);
  const bool waits = review_.awaits_undo(number);
  const ReportEvent event = waits ? ReportEvent::Held : ReportEvent::HeldBack;
  if (transition(report->state, event) == nullptr || (report->state == ReportState::Held && !waits)) {
    return cannot(*report, report->state == ReportState::Held ? "it is held already"
                           : is_final(report->state)          ? "only a queued report can be held"
                                                              : "it may have been sent already");
  }
  if (!book_.move({number, event, "the operator held it"}, time)) return std::unexpected(kDisk);
  review_.decided(number);
  return number;
}

Reports::Outcome Reports::withdraw(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return no_such(number);
  if (transition(report->state, ReportEvent::Withdrawn) == nullptr) {
    return cannot(*report, is_final(report->state) ? "it is finished and cannot be withdrawn"
                           : report->state == ReportState::Sending
                               ? "its sending has begun, so it cannot be undone"
                               : "it may have been recorded; send it, or settle it");
  }
  const char* const why = review_.awaits_undo(number) ? "the operator undid it" : "";
  if (!book_.move({number, ReportEvent::Withdrawn, why}, time)) return std::unexpected(kDisk);
  review_.decided(number);
  return number;
}

Reports::Outcome Reports::settle(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return no_such(number);
  if (transition(report->state, ReportEvent::Settled) == nullptr) {
    return cannot(*report, "only a report in doubt can be settled");
  }
  const bool done = doubts_.blur(number, time) &&
                    book_.move({number, ReportEvent::Settled, "the operator settled it"}, time);
  if (!done) return std::unexpected(kDisk);
  doubts_.ask_for_others(time);
  return number;
}

Reports::Outcome Reports::correct(std::int64_t number, const icd::ArtifactReport& to, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return no_such(number);
  const ReportTransition* const row = transition(report->state, ReportEvent::Corrected);
  if (row == nullptr) return cannot(*report, "only a held report can be corrected");
  if (is_same(report->report, to))
    return cannot(*report, "the correction is the same report; send it instead");
  Report next{.number = book_.next_number(),
              .report = to,
              .sender = "operator",
              .received = time.stamp,
              .changed = time.stamp,
              .note = icd::sentence("corrects report ", number, ", ", described(report->report)),
              .run = meant_run().number,
              .asked = true};
  if (!next.report.robot) next.report.robot = report->report.robot;
  if (const Report* const other = review_.twin(next); other != nullptr) {
    return cannot(*report, icd::sentence("report ", other->number, " is the same as the correction and is ",
                                         shown_name_of(other->state), " in this run"));
  }
  Report corrected = *report;
  corrected.state = row->to;
  corrected.changed = time.stamp;
  corrected.note = icd::sentence("the operator corrected it: report ", next.number, ", ", described(to));
  corrected.run = next.run;
  corrected.same_as = next.number;
  const std::int64_t made = add(std::move(next), review_.hold_for_undo(), false, time, {&corrected, 1});
  if (made == 0) return std::unexpected(kDisk);
  clients_.hand_over(number, book_.at(made));
  review_.decided(number);
  return made;
}

Reports::Outcome Reports::resubmit(std::int64_t number, Time time) {
  const Report* const report = book_.find(number);
  if (report == nullptr) return no_such(number);
  if (!is_final(report->state)) return cannot(*report, "it is not finished yet");
  if (report->is_lost()) return cannot(*report, kLost);
  for (const Report* const other : review_.same_in_run(report->report)) {
    if (other->asked && !is_final(other->state)) return other->number;  // pressed twice, sent once
  }
  Report again{.report = report->report, .sender = "operator", .received = time.stamp, .changed = time.stamp};
  again.note = icd::sentence("report ", number, " again");
  again.run = meant_run().number;
  again.asked = true;
  const std::int64_t made = add(std::move(again), {}, false, time);
  return made != 0 ? Outcome(made) : std::unexpected(kDisk);
}

}  // namespace adit::dispatch
