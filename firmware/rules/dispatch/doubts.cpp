#include "dispatch/doubts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <ranges>
#include <utility>

#include "codec/json.hpp"
#include "codec/write.hpp"
#include "dispatch/report.hpp"
#include "dispatch/verdicts.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

constexpr std::chrono::seconds kRetryWrite{1};  // after a failed write

std::string metres(double distance) {
  return icd::number_text(std::round(distance * 10) / 10) + " m";
}

/// True if repeats of the report get its answer or wait for it.
bool covers_repeats(const Report& report) {
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
  std::vector<const Report*> same = book_.find_same(report);
  std::erase_if(same, [this](const Report* other) {
    return !account_.is_of_run(*other) || account_.is_unclaimed(*other);
  });
  return same;
}

const Report* ReportReview::earlier(const Report& report) const {
  for (const Report* const other : std::views::reverse(same_in_run(report.report))) {
    if (report.number != 0 && other->number >= report.number) continue;
    const Report& original = original_of(*other, book_);
    if (original.number == report.number || !covers_repeats(original)) continue;
    // The run of a finished report may have ended unnoticed: reason_to_hold().
    if (is_final(original.state) && !account_.runs().name_trouble().empty()) continue;
    return &original;
  }
  return nullptr;
}

const Report* ReportReview::find_duplicate(const Report& report) const {
  for (const Report* const other : same_in_run(report.report)) {
    const bool is_compared_later = other->state == ReportState::Queued && !other->asked &&
                                   other->number > report.number && is_unchecked(other->number);
    const bool waits = other->state == ReportState::Held && !awaits_undo(other->number);
    const bool held_back = waits || other->state == ReportState::Withdrawn || is_compared_later;
    if (other->number != report.number && !held_back && covers_repeats(*other)) return other;
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
  for (const Report* const other : book_.find_same(report.report)) {
    const Run* const its = account_.runs().find(other->run);
    if (its == nullptr || its->number == account_.run().number || other->number == report.number) continue;
    if (was_sent(*other) && !effect_of(*other).again && counts(*its)) return other;
  }
  return nullptr;
}

const Report* ReportReview::other_command_post_twin(const Report& report) const {
  if (account_.run().was_heard() || report.asked) return nullptr;
  return sent_elsewhere(report, [this](const Run& its) { return its.post != account_.run().post; });
}

constexpr const char* kMayGoOn = ", whose run may go on: ";

/// Same as a report that was sent in a run that may be the present one.
Hold ReportReview::repeat_hold(const Report& report) const {
  const Run& run = account_.run();
  const Report* const sent =
      sent_elsewhere(report, [this](const Run& its) { return account_.runs().can_be_present(its.number); });
  if (sent != nullptr) {
    const Run& its = *account_.runs().find(sent->run);
    const std::string names =
        !its.id.empty() && its.id == run.id ? ", and the Command Post gives both runs the same name" : "";
    return {icd::sentence("the same as report ", sent->number, kMayGoOn, "a new run is not certain (",
                          run.why, names, ")"),
            sent->number};
  }
  if (const std::string& name_trouble = account_.runs().name_trouble(); !name_trouble.empty()) {
    for (const Report* const other : same_in_run(report.report)) {
      if (other->number == report.number || !was_sent(*other) || effect_of(*other).again) continue;
      return {icd::sentence("the same as report ", other->number, kMayGoOn, "its name does not tell (",
                            name_trouble, ")"),
              other->number};
    }
  }
  for (const Report* const other : book_.find_same(report.report)) {
    if (!account_.is_unclaimed(*other) || effect_of(*other).again) continue;
    return {icd::sentence("the same as report ", other->number, ", answered as a new run may have begun (",
                          run.why, "); the next answer decides"),
            other->number};
  }
  return {};
}

/// The settings may have changed after the last record, so that any other Command Post may have them.
std::vector<const Report*> ReportReview::lost_reports() const {
  const Run& run = account_.run();
  std::vector<const Report*> lost;
  for (const std::int64_t number : book_.numbers_in_doubt()) {
    const Report& report = book_.at(number);
    if (!report.is_lost()) continue;
    const Run* const its = account_.runs().find(report.run);
    if (its == nullptr || its->post != run.post || run.number <= report.run) lost.push_back(&report);
  }
  return lost;
}

Hold ReportReview::reason_to_hold(const Report& report) const {
  if (report.asked) return {};
  if (const auto lost = lost_reports(); !lost.empty()) {
    return {icd::sentence("", lost.front()->note, "; this may be the same report")};
  }
  if (Hold hold = repeat_hold(report); hold.same_as != 0) return hold;
  for (const Report* const other : same_in_run(report.report)) {
    if (!other->is_corrected()) continue;
    return {icd::sentence("the same as report ", other->number, ", corrected as report ", other->same_as)};
  }
  if (rules_.review == Review::Off) return {};
  for (const auto& [number, other] : book_.all()) {
    // Of two queued reports the later one is held.
    const bool later = report.number != 0 && number > report.number && other.state == ReportState::Queued;
    const bool counts = account_.is_of_run(other) && !later && number != report.number &&
                        other.state != ReportState::Withdrawn;
    if (counts && is_near(other.report, report.report, rules_.near_metres) && covers_repeats(other)) {
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
                               " s; then it is sent, unless the box restarts or a new run begins before"),
          .for_undo = true};
}

void ReportReview::await_undo(std::int64_t number, Time time) {
  undo_[number] = {time.now + rules_.undo, time.stamp + static_cast<double>(rules_.undo.count())};
}

void ReportReview::end_undo(std::int64_t number) {
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

void ReportReview::on_decided(std::int64_t number) {
  undo_.erase(number);
  on_compared(number);
}

namespace {

using codec::Value;

/// ISO 8601 in UTC (ICD 5.2 submitted_datetime).
std::string date_and_time(double stamp) {
  const auto seconds = static_cast<std::time_t>(std::floor(stamp));
  std::tm parts{};
  char text[64];
  if (gmtime_r(&seconds, &parts) == nullptr) return "";
  const std::size_t date = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
  const int rest = std::snprintf(text + date, sizeof text - date, ".%06d+00:00",
                                 static_cast<int>((stamp - std::floor(stamp)) * 1e6));
  return {text, date + static_cast<std::size_t>(rest)};
}

Value text_or_null(const std::string& text) {
  return text.empty() ? Value{} : Value{text};
}

}  // namespace

std::string reconciled_answer(const Report& report, const Run& run, std::optional<std::int64_t> points,
                              const std::string& figures) {
  const icd::Point& at = report.report.position;
  return codec::write_json({Value::Object{
      {"url", Value{}},
      {"id", Value{}},
      {"x", {at.x}},
      {"y", {at.y}},
      {"z", {at.z}},
      {"type", {report.report.type}},
      {"submitted_datetime", {date_and_time(report.sent)}},
      {"run_clock", report.before ? Value{std::round(report.before->run_clock * 1000) / 1000} : Value{}},
      {"team", text_or_null(run.last ? run.last->current_team : "")},
      {"run", text_or_null(run.id)},
      {"report_status", {std::string("scored")}},
      {"score_change", points ? Value{*points} : Value{}},
      {"adit",
       {Value::Object{{"reconciled", {true}}, {"report", {report.number}}, {"evidence", {figures}}}}}}});
}

namespace {

/// Empty if the run's status can decide a group that begins with this report.
std::string group_undecidable_reason(const Report& report, const Run& run, const Run* its) {
  if (its != nullptr && !its->post.empty() && its->post != run.post) {
    return "it was sent to another Command Post: the one at " + its->post +
           " is asked when the settings name it again";
  }
  if (report.run != run.number) return "a new run began before the counts could tell";
  if (!run.unreliable.empty()) return run.unreliable;
  if (!report.before && report.sent < run.began) {
    return "a new run began just after it was sent: either run may have recorded it";
  }
  if (!report.before) {
    return report.uncertain.empty() ? "the Command Post's counts before it was sent are not certain"
                                    : report.uncertain;
  }
  return "";
}

LaterReports later_reports(const Report& doubt, const ReportBook& book) {
  LaterReports since;
  for (const auto& [number, report] : book.all()) {
    if (report.run != doubt.run || report.sending <= doubt.sending) continue;
    const Effect effect = effect_of(report);
    since.scored += effect.scored ? 1 : 0;
    since.points += effect.points.value_or(0);
    since.unclear += effect.points ? 0 : 1;
  }
  return since;
}

constexpr const char* kOperator = "; the operator decides: Send again or Settle";

}  // namespace

std::vector<Doubts::Reports> Doubts::groups() const {
  std::vector<Reports> groups;
  for (const Report* const doubt : all()) {
    if (doubt->before) groups.emplace_back();
    if (!groups.empty()) groups.back().push_back(doubt);
  }
  return groups;
}

const Report* Doubts::leader_of(const Report& doubt) const {
  for (const Reports& group : groups()) {
    if (std::ranges::find(group, doubt.number, &Report::number) != group.end()) return group.front();
  }
  return &doubt;
}

std::string Doubts::undecidable_reason(const Report& doubt) const {
  const Report& first = *leader_of(doubt);
  return group_undecidable_reason(first, account_.run(), account_.runs().find(first.run));
}

bool Doubts::has_open_group() const {
  return std::ranges::any_of(groups(), [](const Reports& group) {
    return std::ranges::any_of(group, [](const Report* doubt) { return !doubt->counted; });
  });
}

std::int64_t Doubts::open_count() const {
  std::int64_t open = 0;
  for (const Report* const doubt : all()) {
    if (doubt->before) break;
    open += doubt->counted ? 0 : 1;
  }
  return open;
}

bool Doubts::is_asking(const Report& report) const {
  if (report.state != ReportState::InDoubt || report.run != account_.run().number) return false;
  const auto inquiry = inquiries_.find(leader_of(report)->number);
  return inquiry != inquiries_.end() && !inquiry->second.has_timed_out();
}

bool Doubts::is_pending(Instant now) const {
  return std::ranges::any_of(inquiries_, [now](const auto& each) { return each.second.is_pending(now); });
}

std::optional<Instant> Doubts::next_ask(Instant now) const {
  std::optional<Instant> first;
  for (const auto& [number, inquiry] : inquiries_) {
    first = std::min(first.value_or(inquiry.next_ask(now)), inquiry.next_ask(now));
  }
  return first;
}

void Doubts::open() {
  std::vector<Report> changed;
  std::int64_t others = 0;
  bool has_group = false, is_open = false;
  for (const Report* const doubt : all()) {
    if (doubt->before && (is_open || doubt->beside < others)) {
      Report& report = changed.emplace_back(*doubt);
      if (is_open) report.before.reset();
      report.beside = std::max(report.beside, others);
    }
    has_group = has_group || doubt->before.has_value();
    if (doubt->counted) continue;
    is_open = has_group;
    if (!has_group) ++others;
  }
  if (!changed.empty()) book_.change(changed, account_.run());
}

void Doubts::begin(Instant now) {
  inquiries_.clear();
  for (const Report* const doubt : all()) lost_.try_emplace(doubt->number, now);
  for (const Reports& group : groups()) {
    if (undecidable_reason(*group.front()).empty())
      inquiries_.emplace(group.front()->number, Inquiry(policy_, now));
  }
}

void Doubts::on_lost(std::int64_t number, Instant now) {
  lost_[number] = now;
  account_.forget_expected();
  begin(now);
}

void Doubts::on_failed(Time time) {
  for (const Reports& group : groups()) {
    const auto found = inquiries_.find(group.front()->number);
    if (found == inquiries_.end()) continue;
    Inquiry& inquiry = found->second;
    inquiry.on_asked(time.now);
    inquiry.on_failed(time.now);
    if (inquiry.has_timed_out()) {
      explain(group, "the Command Post does not answer with the run's status", time);
    }
  }
}

/// Later doubts may explain a change, too.
Evidence Doubts::weigh_group(const Reports& group, const icd::RunStatus& status) const {
  const Report& first = *group.front();
  const auto later = std::ranges::count_if(
      all(), [&](const Report* doubt) { return doubt->sending > group.back()->sending; });
  return weigh(*first.before, std::ssize(group), first.beside + later, later_reports(first, book_), status);
}

std::vector<ReportBook::Step> Doubts::decide_by_status(const icd::RunStatus& status, Instant asked,
                                                       Time time) {
  std::vector<ReportBook::Step> steps;
  for (const Reports& group : groups()) {
    const auto found = inquiries_.find(group.front()->number);
    if (found == inquiries_.end()) continue;
    Inquiry& inquiry = found->second;
    inquiry.on_asked(time.now);
    Evidence evidence = weigh_group(group, status);
    evidence.finding = inquiry.add_evidence(evidence, status.run_clock, asked, time.now);
    switch (evidence.finding) {
      case Finding::Recorded:
        for (const Report* const doubt : group) steps.push_back(this->step_for(*doubt, evidence));
        break;
      case Finding::NotRecorded:
        for (const Report* const doubt : group) steps.push_back(missing(*doubt, evidence));
        break;
      case Finding::Contradicts:
        account_.distrust(evidence.why, time.stamp);
        inquiries_.clear();
        explain(all(), "", time);
        return {};
      case Finding::Silent:
        explain(group, evidence.why, time);
        break;
    }
  }
  // The others are the operator's.
  Reports others = all();
  std::erase_if(others,
                [this](const Report* doubt) { return inquiries_.contains(leader_of(*doubt)->number); });
  explain(others, "", time);
  return steps;
}

void Doubts::count(Instant asked, Time time) {
  const Reports doubts = all();
  std::erase_if(inquiries_, [&](const auto& each) {
    return std::ranges::find(doubts, each.first, &Report::number) == doubts.end();
  });
  if (account_.is_stopped()) return;
  std::vector<Report> counted;
  for (const Report* const doubt : doubts) {
    const Instant lost = lost_.try_emplace(doubt->number, time.now).first->second;
    if (!doubt->counted && asked - lost >= policy_.doubt_for) counted.emplace_back(*doubt).counted = true;
  }
  book_.note(counted);
}

ReportBook::Step Doubts::step_for(const Report& doubt, const Evidence& evidence) const {
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
  const Report* const same = doubt.asked ? nullptr : review_.find_duplicate(doubt);
  if (same != nullptr) {
    return {.number = doubt.number,
            .event = ReportEvent::Held,
            .note = icd::sentence("not recorded, and report ", same->number, " is the same and is ",
                                  display_name(same->state), " in this run")};
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
    const std::string why = undecidable_reason(*doubt);
    const std::string note =
        is_asking(*doubt) ? "asking for the run's status: " + seen : (why.empty() ? seen : why) + kOperator;
    if (doubt->note == note) continue;
    Report& report = noted.emplace_back(*doubt);
    report.note = note;
    report.changed = time.stamp;
  }
  book_.note(noted);
}

/// A counted doubt explains no change since a later one was sent.
bool Doubts::blur(std::int64_t decided, Time time) {
  const Report& report = book_.at(decided);
  std::vector<Report> blurred;
  for (const Report* const doubt : book_.doubts(report.run)) {
    if (doubt->number == decided || !doubt->before) continue;
    if (report.counted && doubt->sending > report.sending) continue;
    Report& other = blurred.emplace_back(*doubt);
    if (report.counted) {
      ++other.beside;
    } else {
      other.before.reset();
      other.uncertain =
          icd::sentence("the operator decided about report ", decided, ", which was in doubt, too");
    }
  }
  if (!book_.note(blurred)) return false;
  if (report.run != account_.run().number) return true;  // no inquiry there
  if (!report.counted) account_.forget_expected(time.now + policy_.doubt_for);
  begin(time.now);
  return true;
}

void Doubts::ask_for_others(Time time) {
  begin(time.now);
  explain(all(), "", time);
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

}  // namespace adit::dispatch
