#include "dispatch/report_review.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

#include "dispatch/report_verdict.hpp"
#include "dispatch/same_report.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

constexpr std::chrono::seconds kRetryWrite{1};  // after a failed write

std::string metres(double distance) {
  return icd::number_text(std::round(distance * 10) / 10) + " m";
}

/// True if repeats of the report get its answer or wait for it.
bool stands_for_others(const Report& report) {
  if (report.state == ReportState::Rejected) return false;  // not recorded, so a repeat is sent
  return !effect_of(report).again;
}

/// True if the Command Post has it or may have it.
bool was_sent(const Report& report) {
  return report.state == ReportState::Answered || report.state == ReportState::Settled ||
         report.state == ReportState::InDoubt;
}

/// The report whose answer repeats of `report` get: itself, or the one that it joined or that corrects it.
const Report& original_of(const Report& report, const ReportBook& book) {
  const Report* original = &report;
  for (std::size_t i = 0; i < book.all().size() && original->state == ReportState::Withdrawn; ++i) {
    const Report* const next = book.find(original->same_as);
    if (next == nullptr) break;
    original = next;
  }
  return *original;
}

}  // namespace

std::vector<const Report*> ReportReview::same_in_run(const icd::ArtifactReport& report) const {
  std::vector<const Report*> same = book_.same_as(report);
  std::erase_if(same, [this](const Report* other) {
    return !account_.is_of_run(*other) || account_.is_unclaimed(*other);
  });
  return same;
}

const Report* ReportReview::earlier(const Report& report) const {
  for (const Report* const other : std::views::reverse(same_in_run(report.report))) {
    if (report.number != 0 && other->number >= report.number) continue;
    const Report& original = original_of(*other, book_);
    if (original.number == report.number || !stands_for_others(original)) continue;
    // The run of a finished report may have ended unnoticed: reason_to_hold().
    if (is_final(original.state) && !account_.runs().name_trouble().empty()) continue;
    return &original;
  }
  return nullptr;
}

const Report* ReportReview::twin(const Report& report) const {
  for (const Report* const other : same_in_run(report.report)) {
    const bool is_compared_later = other->state == ReportState::Queued && !other->asked &&
                                   other->number > report.number && is_unchecked(other->number);
    const bool waits = other->state == ReportState::Held && !awaits_undo(other->number);
    const bool held_back = waits || other->state == ReportState::Withdrawn || is_compared_later;
    if (other->number != report.number && !held_back && stands_for_others(*other)) return other;
  }
  return nullptr;
}

const Report* ReportReview::answered_later(const Report& report) const {
  for (const Report* const other : same_in_run(report.report)) {
    if (other->state == ReportState::Answered && other->sending > report.sending) return other;
  }
  return nullptr;
}

/// The same report, sent in another run that satisfies `counts`, or null.
const Report* ReportReview::sent_elsewhere(const Report& report,
                                           const std::function<bool(const Run&)>& counts) const {
  for (const Report* const other : book_.same_as(report.report)) {
    const Run* const its = account_.runs().find(other->run);
    if (its == nullptr || its->number == account_.run().number || other->number == report.number) continue;
    if (was_sent(*other) && !effect_of(*other).again && counts(*its)) return other;
  }
  return nullptr;
}

const Report* ReportReview::sent_to_other_command_post(const Report& report) const {
  if (account_.run().was_heard() || report.asked) return nullptr;
  return sent_elsewhere(report, [this](const Run& its) { return its.post != account_.run().post; });
}

/// Same as a report that was sent in a run that may be the present one.
Hold ReportReview::maybe_repeat(const Report& report) const {
  const Run& run = account_.run();
  const Report* const sent =
      sent_elsewhere(report, [this](const Run& its) { return account_.runs().may_be_present(its.number); });
  if (sent != nullptr) {
    const Run& its = *account_.runs().find(sent->run);
    const std::string names =
        !its.id.empty() && its.id == run.id ? ", and the Command Post gives both runs the same name" : "";
    return {icd::sentence("the same as report ", sent->number,
                          ", and its run may still go on: a new run is not certain (", run.why, names, ")"),
            sent->number};
  }
  if (const std::string& name_trouble = account_.runs().name_trouble(); !name_trouble.empty()) {
    for (const Report* const other : same_in_run(report.report)) {
      if (other->number == report.number || !was_sent(*other) || effect_of(*other).again) continue;
      return {
          icd::sentence("the same as report ", other->number,
                        ", and the Command Post does not show whether its run goes on (", name_trouble, ")"),
          other->number};
    }
  }
  for (const Report* const other : book_.same_as(report.report)) {
    if (!account_.is_unclaimed(*other) || effect_of(*other).again) continue;
    return {icd::sentence("the same as report ", other->number,
                          ", which was answered when the new run may already have begun (", run.why,
                          "); the next answer decides"),
            other->number};
  }
  return {};
}

Hold ReportReview::reason_to_hold(const Report& report) const {
  if (report.asked) return {};
  for (const Report* const doubt : book_.doubts(account_.run().number)) {
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
    const bool counts = account_.is_of_run(other) && !later && number != report.number &&
                        other.state != ReportState::Withdrawn;
    if (counts && is_near(other.report, report.report, rules_.near_metres) && stands_for_others(other)) {
      return {icd::sentence("the same type as report ", number, ", ",
                            metres(distance(other.report, report.report)), " from it")};
    }
  }
  return rules_.review == Review::All ? Hold{"every report is reviewed"} : Hold{};
}

/// The note stays true if a restart or a new run leaves the report held.
Hold ReportReview::hold_for_undo() const {
  if (rules_.undo.count() == 0) return {};
  return {.why = icd::sentence("you can undo it for ", rules_.undo.count(),
                               " s; then it is sent, unless aditd restarts or a new run begins before"),
          .for_undo = true};
}

void ReportReview::await_undo(std::int64_t number, Time time) {
  undo_[number] = {time.now + rules_.undo, time.stamp + static_cast<double>(rules_.undo.count())};
}

void ReportReview::undo_over(std::int64_t number) {
  undo_.erase(number);
  compare_later(number);
}

std::optional<double> ReportReview::sends_at(std::int64_t number) const {
  const auto undo = undo_.find(number);
  return undo == undo_.end() ? std::nullopt : std::optional(undo->second.stamp);
}

std::optional<Instant> ReportReview::next_undo() const {
  std::optional<Instant> first;
  for (const auto& [number, undo] : undo_) first = std::min(first.value_or(undo.until), undo.until);
  return first;
}

std::vector<std::int64_t> ReportReview::late_undos(Instant now) {
  std::vector<std::int64_t> late;
  for (auto& [number, undo] : undo_) {
    if (undo.until > now) continue;
    late.push_back(number);
    undo.until = now + kRetryWrite;
  }
  return late;
}

std::vector<std::int64_t> ReportReview::end_undos() {
  std::vector<std::int64_t> ended;
  for (const auto& [number, undo] : std::exchange(undo_, {})) ended.push_back(number);
  return ended;
}

void ReportReview::decided(std::int64_t number) {
  undo_.erase(number);
  compared(number);
}

}  // namespace adit::dispatch
