// Changes of the run and their effect on reports.
#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "codec/read.hpp"
#include "dispatch/report_verdict.hpp"
#include "dispatch/reports.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// True if the Command Post has it or may have it.
bool was_sent(const Report& report) {
  return report.state == ReportState::Answered || report.state == ReportState::Settled ||
         report.state == ReportState::InDoubt;
}

/// Moves a report from a run without any status to run `run`. The operator's order to send it applied to the
/// other run alone.
Report passed_on(Report report, std::int64_t run, Time time) {
  if (report.run != run) report.asked = false;
  report.run = run;
  report.note = "";
  report.changed = time.stamp;
  return report;
}

/// Until the run is certain.
bool is_held_as_repeat(const Report& report) {
  return report.state == ReportState::Held && report.same_as != 0;
}

/// It certainly repeats `original`.
Report joined_to(std::int64_t original, Report report, Time time) {
  report.state = transition(report.state, ReportEvent::Joined)->to;
  report.note = icd::sentence("the same as report ", original);
  report.changed = time.stamp;
  return report;
}

/// From a recorded report's answer; "" if missing.
std::string run_in(const std::string& answer) {
  const auto reply = codec::read_report_reply(answer);
  return reply ? reply->run : "";
}

std::string why_at(const std::string& post, const std::string& before) {
  return "the Command Post is at " + post + ", it was at " + before;
}

}  // namespace

void Reports::will_move(const std::string& post, Time time) {
  will_be_ = 0;
  if (post != run().post) {
    const Run* const known = account_.runs().at_post(post);
    will_be_ = known != nullptr ? known->number : account_.announce(why_at(post, run().post), post, time);
    return;
  }
  std::vector<Report> steps;
  for (const std::int64_t number : book_.waiting()) {
    const Run* const meant = account_.runs().find(book_.at(number).run);
    if (meant == nullptr || meant->was_heard() || meant == &run()) continue;
    steps.push_back(passed_on(book_.at(number), run().number, time));
    unchecked_.insert(number);
  }
  if (!steps.empty()) book_.change(steps, run());
}

/// Queued reports for the old Command Post are kept for it.
void Reports::change_post(const std::string& post, Time time) {
  const std::string from = run().post;
  const Run* const known = account_.runs().at_post(post);
  const std::int64_t next = known != nullptr ? known->number : account_.runs().next_number();
  std::vector<Report> steps;
  for (const std::int64_t number : book_.waiting()) {
    const Report& report = book_.at(number);
    const Run* const meant = account_.runs().find(report.run);
    if (meant != nullptr && !meant->was_heard()) {
      steps.push_back(passed_on(report, next, time));
    } else if (meant == &run() && !from.empty()) {
      Report& kept = steps.emplace_back(report);
      kept.changed = time.stamp;
      kept.note = "kept for the Command Post at " + from;
    }
  }
  const std::vector<const Report*> doubts = book_.doubts(run().number);
  if (known != nullptr) {
    account_.take_up(next, steps, time);
  } else {
    account_.begin(why_at(post, from), 0, std::nullopt, steps, time);
  }
  explain(doubts, "", time);
  doubt_began(time.now);
}

void Reports::meet(const AnotherRun& another, const icd::RunStatus& status, Time time) {
  const bool other_team = run().last && are_other_teams(run().last->current_team, status.current_team);
  const Run* const known = other_team ? account_.of_team(status.current_team) : nullptr;
  if (known != nullptr) {
    const auto differs = another_run(*known, status, account_.between(known->heard, time.stamp));
    if (!differs) return take_up_run(*known, another.why, time);
    return begin_run(another.why, differs->certain ? 0 : known->number, status, time);
  }
  // More reports are left, so the earlier run has ended and its reports have no repeats here.
  if (run().may_be != 0 && another.certain && !other_team && !anything_was_sent_here()) clear_held(time);
  begin_run(another.why, another.certain ? 0 : run().number, status, time);
}

void Reports::meet(const icd::ReportReply& reply, Time time) {
  if (const auto another = account_.another(reply, time)) {
    const Run* const known = another->certain ? account_.of_name(reply.run) : nullptr;
    if (known != nullptr) return take_up_run(*known, another->why, time);
    return begin_run(another->why, another->certain ? 0 : run().number, std::nullopt, time);
  }
  if (reply.run.empty() || !run().id.empty()) return;
  const Run* const before = account_.named_before();
  if (before == nullptr) return claim(reply.run, time);
  if (before->id == reply.run) return return_to(*before, time);
  account_.is_not(before->number);
  clear_held(time);
}

bool Reports::anything_was_sent_here() const {
  for (const auto& [number, report] : book_.all()) {
    if (report.run == run().number && report.sending != 0) return true;
  }
  return false;
}

/// Queued reports are held, young ones go on into the new run. Either run may have recorded a doubt that was
/// sent around the last status, so it enters the new one.
std::vector<Report> Reports::steps_into(std::int64_t next, const std::string& why, Time time) {
  const std::chrono::duration<double> late = rules_.policy.doubt_for + kYoung;
  const double last_word = run().heard - late.count();
  std::vector<Report> steps;
  const auto step_of = [&](const Report& report, bool enters) {
    Report& changed = steps.emplace_back(report);
    changed.changed = time.stamp;
    if (enters) {
      changed.run = next;
      changed.before.reset();
    } else {
      changed.state = transition(report.state, ReportEvent::Held)->to;
      changed.note = "a new run began (" + why + ")";
    }
  };
  for (const Report* const doubt : book_.doubts(run().number)) {
    if (doubt->sent >= last_word) step_of(*doubt, true);
  }
  for (const std::int64_t number : book_.waiting()) {
    const Report& report = book_.at(number);
    if (!account_.runs().is_here(report.run)) continue;
    const bool enters = is_young(report, time.now);
    step_of(report, enters);
    if (enters) unchecked_.insert(number);
  }
  for (const auto& [number, undo] : std::exchange(undo_, {})) step_of(book_.at(number), false);
  return steps;
}

/// Either run may have recorded them.
std::vector<Report> Reports::answered_since_status(std::int64_t next) const {
  std::vector<Report> steps;
  for (const auto& [number, report] : book_.all()) {
    const bool since = report.state == ReportState::Answered && report.changed > account_.status_at();
    if (report.run == run().number && since) steps.emplace_back(report).run = next;
  }
  return steps;
}

/// Answered before the run was noticed, and its name is not known: it may be of the earlier run.
bool Reports::is_unclaimed(const Report& report) const {
  return report.run == run().number && report.state == ReportState::Answered &&
         report.changed < run().began && run().id.empty();
}

/// The first answer with a name decides about unclaimed reports. Same name: held repeats get their answer.
/// Another name: they move to that run. No name: they stay, so that no report is sent twice.
void Reports::claim(const std::string& name, Time time) {
  std::vector<Report> steps;
  for (const auto& [number, report] : book_.all()) {
    const std::string other = is_unclaimed(report) ? run_in(report.answer) : "";
    if (other.empty() || other == name) continue;
    const Run* const its = account_.of_name(other);
    if (its != nullptr) steps.emplace_back(report).run = its->number;
  }
  std::vector<std::pair<std::int64_t, std::int64_t>> joined;
  for (const std::int64_t number : book_.open()) {
    const Report& report = book_.at(number);
    if (!is_held_as_repeat(report) || report.run != run().number) continue;
    const Report& original = book_.at(report.same_as);
    if (!is_unclaimed(original) || run_in(original.answer) != name) continue;
    steps.push_back(joined_to(original.number, report, time));
    joined.emplace_back(number, original.number);
  }
  if (!steps.empty()) book_.change(steps, run());
  for (const auto& [number, original] : joined) hand_clients_over(number, book_.at(original));
  clear_held(time);
}

void Reports::begin_run(const std::string& why, std::int64_t may_be,
                        const std::optional<icd::RunStatus>& status, Time time) {
  const auto doubts = book_.doubts(run().number);
  const std::int64_t next = account_.runs().next_number();
  auto steps = steps_into(next, why, time);
  if (status && may_be == 0) std::ranges::copy(answered_since_status(next), std::back_inserter(steps));
  inquiry_.reset();
  account_.begin(why, may_be, status, steps, time);
  explain(doubts, "", time);
}

void Reports::take_up_run(const Run& known, const std::string& why, Time time) {
  const std::int64_t number = known.number;
  const auto doubts = book_.doubts(run().number);
  const auto steps = steps_into(number, why, time);
  account_.take_up(number, steps, time);
  explain(doubts, "", time);
  doubt_began(time.now);
}

/// The present run is `known`, and so are the runs between them: all their reports move there. Held repeats
/// get the originals' answers.
void Reports::return_to(const Run& known, Time time) {
  const std::int64_t number = known.number;
  const auto maybe = account_.runs().maybe_present();
  const std::set<std::int64_t> merged(maybe.begin(), std::ranges::find(maybe, number));
  std::vector<Report> steps;
  std::vector<std::pair<std::int64_t, std::int64_t>> joined;
  for (const auto& [each, report] : book_.all()) {
    if (!merged.contains(report.run)) continue;
    Report& changed = steps.emplace_back(report);
    changed.run = number;
    changed.changed = time.stamp;
    if (report.state == ReportState::InDoubt) changed.before.reset();
    if (report.state == ReportState::Queued) unchecked_.insert(each);
    if (!is_held_as_repeat(report)) continue;
    const std::int64_t its_run = book_.at(report.same_as).run;
    if (its_run != number && !merged.contains(its_run)) continue;
    changed = joined_to(report.same_as, changed, time);
    joined.emplace_back(each, report.same_as);
  }
  account_.merge_into(number, steps, time);
  for (const auto& [each, original] : joined) hand_clients_over(each, book_.at(original));
  doubt_began(time.now);
}

/// The present run is certainly another.
void Reports::clear_held(Time time) {
  std::vector<ReportBook::Step> steps;
  for (const std::int64_t number : book_.open()) {
    const Report& report = book_.at(number);
    if (!is_held_as_repeat(report) || report.run != run().number) continue;
    steps.push_back({number, ReportEvent::Cleared,
                     icd::sentence("report ", report.same_as, " is of another run"),
                     [](Report& cleared) { cleared.same_as = 0; }});
    unchecked_.insert(number);
  }
  if (!steps.empty()) take_steps(steps, time);
}

/// The same report, sent in another run that satisfies `counts`, or null.
const Report* Reports::sent_elsewhere(const Report& report,
                                      const std::function<bool(const Run&)>& counts) const {
  for (const Report* const other : book_.same_as(report.report)) {
    const Run* const its = account_.runs().find(other->run);
    if (its == nullptr || its->number == run().number || other->number == report.number) continue;
    if (was_sent(*other) && !effect_of(*other).again && counts(*its)) return other;
  }
  return nullptr;
}

/// The same report, answered when the present run may already have begun, or null.
const Report* Reports::unclaimed_same(const Report& report) const {
  for (const Report* const other : book_.same_as(report.report)) {
    if (is_unclaimed(*other) && !effect_of(*other).again) return other;
  }
  return nullptr;
}

/// The same report, sent in a run that the present one may still be, or null.
const Report* Reports::same_in_maybe(const Report& report) const {
  return sent_elsewhere(report,
                        [this](const Run& its) { return account_.runs().may_be_present(its.number); });
}

/// The same report, sent to another Command Post, if this one has not answered yet. Otherwise null.
const Report* Reports::sent_to_another_post(const Report& report) const {
  if (run().was_heard() || report.asked) return nullptr;
  return sent_elsewhere(report, [this](const Run& its) { return its.post != run().post; });
}

std::int64_t Reports::declare_new_run(Time time) {
  constexpr const char* kWhy = "the operator declared it";
  if (will_be_ != 0) return will_be_ = account_.announce(kWhy, meant_run().post, time);
  begin_run(kWhy, 0, std::nullopt, time);
  return run().number;
}

}  // namespace adit::dispatch
