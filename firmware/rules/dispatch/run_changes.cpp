#include "dispatch/run_changes.hpp"

#include <algorithm>
#include <ranges>
#include <set>
#include <utility>

#include "codec/read.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// Moves a report from a run without any status to run `run`. The operator's order to send it applied to the
/// other run alone. If it was sent before that order, this run may have it, so it is held.
Report passed_on(Report report, std::int64_t run, Time time) {
  const bool was_ordered = report.run != run && std::exchange(report.asked, false);
  report.run = run;
  report.note = "";
  report.changed = time.stamp;
  if (!was_ordered || report.sending == 0) return report;
  report.state = transition(report.state, ReportEvent::Held)->to;
  report.note = "the operator sent it to another Command Post, which did not answer";
  return report;
}

/// Until the run is certain.
bool is_held_as_repeat(const Report& report) {
  return report.state == ReportState::Held && report.same_as != 0;
}

/// It certainly repeats the report `same_as`.
Report joined_repeat(Report report, Time time) {
  report.state = transition(report.state, ReportEvent::Joined)->to;
  report.note = icd::sentence("the same as report ", report.same_as);
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

void RunChanges::will_move(const std::string& post, Time time) {
  const Run& run = account_.run();
  account_.will_be(0);
  if (post != run.post) {
    const Run* const known = account_.runs().at_post(post);
    if (known != nullptr) return account_.will_be(known->number);
    account_.announce(why_at(post, run.post), post, time);
    return;
  }
  std::vector<Report> steps;
  for (const std::int64_t number : book_.waiting()) {
    const Run* const meant = account_.runs().find(book_.at(number).run);
    if (meant == nullptr || meant->was_heard() || meant == &run) continue;
    steps.push_back(passed_on(book_.at(number), run.number, time));
    review_.compare_later(number);
  }
  if (!steps.empty()) book_.change(steps, run);
}

/// Queued reports for the old Command Post are kept for it.
void RunChanges::change_post(const std::string& post, Time time) {
  const std::string from = account_.run().post;
  const Run* const known = account_.runs().at_post(post);
  const std::int64_t next = known != nullptr ? known->number : account_.runs().next_number();
  std::vector<Report> steps;
  for (const std::int64_t number : book_.waiting()) {
    const Report& report = book_.at(number);
    const Run* const meant = account_.runs().find(report.run);
    if (meant != nullptr && !meant->was_heard()) {
      steps.push_back(passed_on(report, next, time));
    } else if (meant == &account_.run() && !from.empty()) {
      Report& kept = steps.emplace_back(report);
      kept.changed = time.stamp;
      kept.note = "kept for the Command Post at " + from;
    }
  }
  const std::vector<const Report*> doubts = doubts_.all();
  if (known != nullptr) {
    account_.take_up(next, steps, time);
  } else {
    account_.begin(why_at(post, from), 0, std::nullopt, steps, time);
  }
  doubts_.explain(doubts, "", time);
  doubts_.begin(time.now);
}

void RunChanges::meet(const icd::RunStatus& status, Time time) {
  const auto another = account_.another(status, time);
  if (!another) return;
  const Run& run = account_.run();
  const bool other_team = run.last && are_other_teams(run.last->current_team, status.current_team);
  const Run* const known = other_team ? account_.of_team(status.current_team) : nullptr;
  if (known != nullptr) {
    const auto differs = another_run(*known, status, account_.between(known->heard, time.stamp));
    if (!differs) return take_up(*known, another->why, time);
    return begin(another->why, differs->certain ? 0 : known->number, status, time);
  }
  // More reports are left, so the earlier run has ended and its reports have no repeats here.
  const bool is_untouched = std::ranges::none_of(
      book_.all() | std::views::values,
      [&run](const Report& report) { return report.run == run.number && report.sending != 0; });
  if (run.may_be != 0 && another->certain && !other_team && is_untouched) clear_held(time);
  begin(another->why, another->certain ? 0 : run.number, status, time);
}

void RunChanges::meet(const icd::ReportReply& reply, Time time) {
  if (const auto another = account_.another(reply, time)) {
    const Run* const known = another->certain ? account_.of_name(reply.run) : nullptr;
    if (known != nullptr) return take_up(*known, another->why, time);
    return begin(another->why, another->certain ? 0 : account_.run().number, std::nullopt, time);
  }
  if (reply.run.empty() || !account_.run().id.empty()) return;
  const Run* const before = account_.named_before();
  if (before == nullptr) return claim(reply.run, time);
  if (before->id == reply.run) return return_to(*before, time);
  account_.is_not(before->number);
  clear_held(time);
}

/// Queued reports are held, young ones go on into the new run. Either run may have recorded a doubt that was
/// sent around the last status, so it enters the new one.
std::vector<Report> RunChanges::steps_into(std::int64_t next, const std::string& why, Time time) {
  const std::chrono::duration<double> late = policy_.doubt_for + WaitingClients::kYoung;
  const double last_word = account_.run().heard - late.count();
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
  for (const Report* const doubt : doubts_.all()) {
    if (doubt->sent >= last_word) step_of(*doubt, true);
  }
  for (const std::int64_t number : book_.waiting()) {
    const Report& report = book_.at(number);
    if (!account_.runs().is_here(report.run)) continue;
    const bool enters = clients_.is_young(report, time.now);
    step_of(report, enters);
    if (enters) review_.compare_later(number);
  }
  for (const std::int64_t number : review_.end_undos()) step_of(book_.at(number), false);
  return steps;
}

/// The first answer with a name decides about unclaimed reports. Same name: held repeats get their answer.
/// Another name: they move to that run. No name: they stay, so that no report is sent twice.
void RunChanges::claim(const std::string& name, Time time) {
  std::vector<Report> steps;
  for (const auto& [number, report] : book_.all()) {
    const std::string other = account_.is_unclaimed(report) ? run_in(report.answer) : "";
    if (other.empty() || other == name) continue;
    const Run* const its = account_.of_name(other);
    if (its != nullptr) steps.emplace_back(report).run = its->number;
  }
  std::vector<std::int64_t> repeats;
  for (const std::int64_t number : book_.open()) {
    const Report& report = book_.at(number);
    if (!is_held_as_repeat(report) || report.run != account_.run().number) continue;
    const Report& original = book_.at(report.same_as);
    if (!account_.is_unclaimed(original) || run_in(original.answer) != name) continue;
    steps.push_back(joined_repeat(report, time));
    repeats.push_back(number);
  }
  if (!steps.empty()) book_.change(steps, account_.run());
  hand_over(repeats);
  clear_held(time);
}

void RunChanges::begin(const std::string& why, std::int64_t may_be,
                       const std::optional<icd::RunStatus>& status, Time time) {
  const auto doubts = doubts_.all();
  const std::int64_t next = account_.runs().next_number();
  auto steps = steps_into(next, why, time);
  // Either run may have recorded reports that were answered since the last status.
  for (const auto& [number, report] : book_.all()) {
    const bool since = report.state == ReportState::Answered && report.changed > account_.status_at();
    const bool is_here = report.run == account_.run().number;
    if (status && may_be == 0 && is_here && since) steps.emplace_back(report).run = next;
  }
  account_.begin(why, may_be, status, steps, time);
  doubts_.begin(time.now);
  doubts_.explain(doubts, "", time);
}

void RunChanges::take_up(const Run& known, const std::string& why, Time time) {
  const std::int64_t number = known.number;
  const auto doubts = doubts_.all();
  const auto steps = steps_into(number, why, time);
  account_.take_up(number, steps, time);
  doubts_.explain(doubts, "", time);
  doubts_.begin(time.now);
}

/// The present run is `known`, and so are the runs between them: all their reports move there. Held repeats
/// get the originals' answers.
void RunChanges::return_to(const Run& known, Time time) {
  const std::int64_t number = known.number;
  const auto maybe = account_.runs().maybe_present();
  const std::set<std::int64_t> merged(maybe.begin(), std::ranges::find(maybe, number));
  std::vector<Report> steps;
  std::vector<std::int64_t> repeats;
  for (const auto& [each, report] : book_.all()) {
    if (!merged.contains(report.run)) continue;
    Report& changed = steps.emplace_back(report);
    changed.run = number;
    changed.changed = time.stamp;
    if (report.state == ReportState::InDoubt) changed.before.reset();
    if (report.state == ReportState::Queued) review_.compare_later(each);
    if (!is_held_as_repeat(report)) continue;
    const std::int64_t its_run = book_.at(report.same_as).run;
    if (its_run != number && !merged.contains(its_run)) continue;
    changed = joined_repeat(changed, time);
    repeats.push_back(each);
  }
  account_.merge_into(number, steps, time);
  hand_over(repeats);
  doubts_.begin(time.now);
}

/// Gives the clients of `repeats` to the reports that these repeat.
void RunChanges::hand_over(const std::vector<std::int64_t>& repeats) {
  for (const std::int64_t number : repeats) clients_.hand_over(number, book_.at(book_.at(number).same_as));
}

/// The present run is certainly another.
void RunChanges::clear_held(Time time) {
  std::vector<ReportBook::Step> steps;
  for (const std::int64_t number : book_.open()) {
    const Report& report = book_.at(number);
    if (!is_held_as_repeat(report) || report.run != account_.run().number) continue;
    steps.push_back({number, ReportEvent::Cleared,
                     icd::sentence("report ", report.same_as, " is of another run"),
                     [](Report& cleared) { cleared.same_as = 0; }});
    review_.compare_later(number);
  }
  book_.move(steps, time);
}

std::int64_t RunChanges::declare(Time time) {
  constexpr const char* kWhy = "the operator declared it";
  if (&account_.meant_run() != &account_.run()) {
    return account_.announce(kWhy, account_.meant_run().post, time);
  }
  begin(kWhy, 0, std::nullopt, time);
  return account_.run().number;
}

}  // namespace adit::dispatch
