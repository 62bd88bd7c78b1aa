// Reports and clients: accepting, repeats, answers.
#include <algorithm>
#include <cmath>
#include <ranges>

#include "dispatch/report_verdict.hpp"
#include "dispatch/reports.hpp"
#include "dispatch/same_report.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

constexpr const char* kAskAgain =
    "; post the same report again to ask for its state; Adit never sends it twice";
constexpr const char* kOldRun = "; it is of an earlier run; post it again to send it in the present run";

std::string metres(double distance) {
  return icd::number_text(std::round(distance * 10) / 10) + " m";
}

/// True if repeats of the report get its answer or wait for it.
bool stands_for_others(const Report& report) {
  if (report.state == ReportState::Rejected) return false;  // not recorded, so a repeat is sent
  return !effect_of(report).again;
}

}  // namespace

bool Reports::take(const Posted& posted, ClientId client, bool may_send, Time time) {
  Report report{
      .report = posted.report, .sender = posted.sender, .received = time.stamp, .changed = time.stamp};
  report.run = meant_run().number;
  report.asked = posted.resubmit;
  const bool fresh = is_fresh(time.now);
  const Report* const same = earlier(report);
  // A finished report's run may have ended unnoticed: check() compares later.
  const bool repeats = same != nullptr && (fresh || !is_final(same->state));
  if (repeats && (!report.asked || (same->asked && !is_final(same->state)))) {
    join(client, *same, time);
    return false;
  }
  if (waiting_at(meant_run().post).size() >= rules_.most_waiting) {
    output_.tell(client,
                 {.status = icd::Status::TooManyRequests,
                  .sentence = icd::sentence(rules_.most_waiting,
                                            " reports are queued already; this report was not accepted")},
                 report);
    return false;
  }
  Hold hold = fresh ? reason_to_hold(report) : Hold{};
  if (posted.can_be_undone && hold.why.empty()) hold = hold_for_undo();
  if (const Report* const other = sent_to_another_post(report); other != nullptr) {
    report.note = icd::sentence("the same as report ", other->number,
                                ", which was sent to another Command Post; queued until the Command Post at ",
                                run().post, " answers");
  }
  return take_new(std::move(report), hold, client, may_send, time);
}

/// The note stays true if a restart or a new run leaves the report held.
Reports::Hold Reports::hold_for_undo() const {
  if (rules_.undo.count() == 0) return {};
  return {.why = icd::sentence("you can undo it for ", rules_.undo.count(),
                               " s; then it is sent, unless aditd restarts or a new run begins before"),
          .for_undo = true};
}

/// Queues the report, as if it was posted now. False: the write failed.
bool Reports::end_undo(std::int64_t number, const std::string& note, Time time) {
  if (!step(number, ReportEvent::UndoOver, note, time)) return false;
  undo_.erase(number);
  unchecked_.insert(number);
  taken_at_[number] = time.now;
  return true;
}

std::optional<double> Reports::sends_at(const Report& report) const {
  const auto undo = undo_.find(report.number);
  return undo == undo_.end() ? std::nullopt : std::optional(undo->second.stamp);
}

bool Reports::take_new(Report report, const Hold& hold, ClientId client, bool may_send, Time time) {
  const bool fresh = is_fresh(time.now);
  // Accepting and choosing in one write flush the disk once.
  const bool now = may_send && hold.why.empty() && fresh && !sending_ && waiting_here().empty() &&
                   may_go(report, time.now);
  const std::int64_t number = add(report, hold, now, time);
  if (number == 0) {
    output_.tell(client, {.sentence = "the report could not be stored and was not accepted; post it again"},
                 report);
    return false;
  }
  clients_.add(client, number, time.now + rules_.answer_within);
  if (now) sending_ = number;
  if (!fresh) unchecked_.insert(number);
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
  taken_at_[number] = time.now;
  if (hold.for_undo)
    undo_[number] = {time.now + rules_.undo, time.stamp + static_cast<double>(rules_.undo.count())};
  return number;
}

/// Also the report in flight, which a later run may record.
bool Reports::is_of_run(const Report& report) const {
  return report.run == meant_run().number || report.number == sending_;
}

/// The same reports of meant_run(), oldest first.
std::vector<const Report*> Reports::same_in_run(const icd::ArtifactReport& report) const {
  std::vector<const Report*> same;
  for (const Report* const other : book_.same_as(report)) {
    if (is_of_run(*other) && !is_unclaimed(*other)) same.push_back(other);
  }
  return same;
}

/// The report whose answer repeats of `report` get: itself, or the one that it joined or that corrects it.
const Report& Reports::original_of(const Report& report) const {
  const Report* original = &report;
  for (std::size_t i = 0; i < book_.all().size() && original->state == ReportState::Withdrawn; ++i) {
    const Report* const next = book_.find(original->same_as);
    if (next == nullptr) break;
    original = next;
  }
  return *original;
}

/// The report that this one would repeat in the present run, or null.
const Report* Reports::earlier(const Report& report) const {
  for (const Report* const other : std::views::reverse(same_in_run(report.report))) {
    if (report.number != 0 && other->number >= report.number) continue;
    const Report& original = original_of(*other);
    if (original.number != report.number && stands_for_others(original)) return &original;
  }
  return nullptr;
}

/// Another same report of the present run, queued or sent, or null.
const Report* Reports::twin(const Report& report) const {
  for (const Report* const other : same_in_run(report.report)) {
    const bool is_compared_later = other->state == ReportState::Queued && !other->asked &&
                                   other->number > report.number && unchecked_.contains(other->number);
    const bool waits = other->state == ReportState::Held && !undo_.contains(other->number);
    const bool held_back = waits || other->state == ReportState::Withdrawn || is_compared_later;
    if (other->number != report.number && !held_back && stands_for_others(*other)) return other;
  }
  return nullptr;
}

/// Same as a report whose run the next answer decides.
Reports::Hold Reports::maybe_repeat(const Report& report) const {
  if (const Report* const other = same_in_maybe(report); other != nullptr) {
    return {icd::sentence("the same as report ", other->number,
                          ", and its run may still go on: only the clock shows that a new run began (",
                          run().why, ")"),
            other->number};
  }
  if (const Report* const other = unclaimed_same(report); other != nullptr) {
    return {icd::sentence("the same as report ", other->number,
                          ", which was answered when the new run may already have begun (", run().why,
                          "); the next answer decides"),
            other->number};
  }
  return {};
}

Reports::Hold Reports::reason_to_hold(const Report& report) const {
  if (report.asked) return {};
  for (const Report* const doubt : book_.doubts(run().number)) {
    if (doubt->is_lost()) return {icd::sentence("", doubt->note, "; this may be the same report")};
  }
  if (Hold hold = maybe_repeat(report); hold.same_as != 0) return hold;
  for (const Report* const other : same_in_run(report.report)) {
    if (!other->is_corrected()) continue;
    return {icd::sentence("the same as report ", other->number, ", which the operator corrected as report ",
                          other->same_as)};
  }
  if (rules_.review == Review::Off) return {};
  for (const auto& [number, other] : book_.all()) {
    // Of two queued reports the later one is held.
    const bool later = report.number != 0 && number > report.number && other.state == ReportState::Queued;
    const bool counts =
        is_of_run(other) && !later && number != report.number && other.state != ReportState::Withdrawn;
    if (counts && is_near(other.report, report.report, rules_.near_metres) && stands_for_others(other)) {
      return {icd::sentence("the same type as report ", number, ", ",
                            metres(distance(other.report, report.report)), " from it")};
    }
  }
  return rules_.review == Review::All ? Hold{"every report is reviewed"} : Hold{};
}

/// The comparison that take() left out because the run was unknown. False: do not send it now.
bool Reports::check(std::int64_t number, Time time) {
  const Report report = book_.at(number);
  if (report.run != run().number && !report.asked && !is_young(report, time.now)) {
    step(number, ReportEvent::Held, "a new run began (" + run().why + ")", time);
    return false;
  }
  if (!unchecked_.contains(number)) return true;
  const Report* const same = report.asked ? nullptr : earlier(report);
  if (same != nullptr) {
    const std::int64_t original = same->number;
    const bool joined = step(number, ReportEvent::Joined, icd::sentence("the same as report ", original),
                             time, [original](Report& moved) { moved.same_as = original; });
    if (joined) {
      unchecked_.erase(number);
      hand_clients_over(number, book_.at(original));
    }
    return false;
  }
  if (const Hold hold = reason_to_hold(report); !hold.why.empty()) {
    const auto keep = [&hold](Report& held) { held.same_as = hold.same_as; };
    if (step(number, ReportEvent::Held, hold.why, time, keep)) unchecked_.erase(number);
    return false;
  }
  unchecked_.erase(number);
  return true;
}

void Reports::join(ClientId client, const Report& earlier, Time time) {
  if (is_final(earlier.state)) return tell_how_it_stands(client, earlier);
  taken_at_[earlier.number] = time.now;  // meant for the present run
  clients_.add(client, earlier.number, time.now + rules_.answer_within);
}

/// `number` repeats `earlier`.
void Reports::hand_clients_over(std::int64_t number, const Report& earlier) {
  if (is_final(earlier.state)) {
    for (const ClientId client : clients_.take(number)) tell_how_it_stands(client, earlier);
    return;
  }
  clients_.hand_over(number, earlier.number);
  if (const auto taken = taken_at_.find(number); taken != taken_at_.end()) {
    Instant& at = taken_at_.try_emplace(earlier.number, taken->second).first->second;
    at = std::max(at, taken->second);
  }
}

void Reports::tell_how_it_stands(ClientId client, const Report& report) {
  const std::string name = icd::sentence("report ", report.number);
  const std::string why = report.note.empty() ? "" : " (" + report.note + ")";
  const char* const again = is_of_run(report) ? kAskAgain : kOldRun;
  ClientAnswer answer{.number = report.number};
  switch (report.state) {
    case ReportState::Answered:
    case ReportState::Rejected:
      break;  // stored answer
    case ReportState::Settled:
      if (report.reconciled) break;
      answer.status = icd::Status::Conflict;
      answer.sentence = name + " was settled by the operator; its answer is not known" + why +
                        "; to send it again, post it with the header Adit-Resubmit: yes";
      break;
    case ReportState::Withdrawn:
      answer.status = icd::Status::Conflict;
      answer.sentence = name + " was withdrawn by the operator and is not sent" + why +
                        "; to send it, post it with the header Adit-Resubmit: yes";
      break;
    case ReportState::Held:
      answer.sentence = name + " is held until the operator decides" + why + again;
      break;
    case ReportState::InDoubt:
      answer.status = icd::Status::GatewayTimeout;
      answer.sentence = name + " is in doubt: it may or may not have been recorded" + why + again;
      break;
    case ReportState::Queued:
      answer.sentence = (stopping_ ? "aditd is stopping; " : "") + name + " is queued" + why + again;
      break;
    case ReportState::Sending:
      answer.status = icd::Status::GatewayTimeout;
      answer.sentence = name + " is in flight, and may or may not have been recorded yet" + again;
      break;
  }
  output_.tell(client, answer, report);
}

void Reports::dismiss(bool all) {
  stopping_ = true;
  for (const auto& [client, number] : clients_.take_but(all ? std::nullopt : sending_)) {
    tell_how_it_stands(client, book_.at(number));
  }
}

}  // namespace adit::dispatch
