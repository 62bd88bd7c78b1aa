#include "dispatch/run_changes.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "codec/read.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

constexpr const char* kAskAgain =
    "; post the same report again to ask for its state; Adit never sends it twice";
constexpr const char* kOldRun = "; it is of an earlier run; post it again to send it in the present run";

}  // namespace

void WaitingClients::adopt(WaitingClients& before) {
  clients_ = std::exchange(before.clients_, {});
  posted_at_ = std::exchange(before.posted_at_, {});
}

bool WaitingClients::is_young(const Report& report, Instant now) const {
  const auto posted = posted_at_.find(report.number);
  return posted != posted_at_.end() && now - posted->second < kYoung;
}

template <class Which>
void WaitingClients::answer_matching(Which which) {
  std::vector<std::pair<ClientId, std::int64_t>> told;
  std::erase_if(clients_, [&](const auto& item) {
    const bool out = which(item.second);
    if (out) told.emplace_back(item.first, item.second.number);
    return out;
  });
  for (const auto& [client, number] : told) answer_client(client, book_.at(number));
}

void WaitingClients::answer_all(std::int64_t number) {
  answer_matching([number](const Client& client) { return client.number == number; });
}

void WaitingClients::hand_over(std::int64_t number, const Report& earlier) {
  for (auto& [id, client] : clients_) {
    if (client.number == number) client.number = earlier.number;
  }
  if (is_final(earlier.state)) return answer_all(earlier.number);
  if (const auto posted = posted_at_.find(number); posted != posted_at_.end()) {
    Instant& at = posted_at_.try_emplace(earlier.number, posted->second).first->second;
    at = std::max(at, posted->second);
  }
}

void WaitingClients::tick(Instant now) {
  answer_matching([now](const Client& client) { return client.deadline <= now; });
  std::erase_if(posted_at_, [now](const auto& item) { return now - item.second > kYoung; });
}

void WaitingClients::dismiss(bool all) {
  stopping_ = true;
  const Report* const sending = all ? nullptr : book_.sending();
  answer_matching(
      [sending](const Client& client) { return sending == nullptr || client.number != sending->number; });
}

std::optional<std::int64_t> WaitingClients::awaited_report(ClientId client) const {
  const auto found = clients_.find(client);
  return found == clients_.end() ? std::nullopt : std::optional(found->second.number);
}

std::optional<Instant> WaitingClients::next_deadline() const {
  if (clients_.empty()) return std::nullopt;
  const auto first =
      std::ranges::min_element(clients_, {}, [](const auto& item) { return item.second.deadline; });
  return first->second.deadline;
}

void WaitingClients::answer_client(ClientId client, const Report& report) {
  const std::string name = icd::sentence("report ", report.number);
  const std::string why = report.note.empty() ? "" : " (" + report.note + ")";
  const char* const again = account_.is_of_run(report) ? kAskAgain : kOldRun;
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
      answer.sentence = (stopping_ ? "the box is stopping; " : "") + name + " is queued" + why + again;
      break;
    case ReportState::Sending:
      answer.status = icd::Status::GatewayTimeout;
      answer.sentence = name + " is in flight, and may or may not have been recorded yet" + again;
      break;
  }
  output_.answer_client(client, answer, report);
}

namespace {

/// Moves a report from a run without any status to run `run`. The operator's order to send it applied to the
/// other run alone. If it was sent before that order, this run may have it, so it is held.
Report transfer_report(Report report, std::int64_t run, Time time) {
  const bool was_ordered = report.run != run && std::exchange(report.asked, false);
  report.run = run;
  report.note = "";
  report.changed = time.stamp;
  if (!was_ordered || report.sending == 0) return report;
  report.state = transition(report.state, ReportEvent::Held)->to;
  report.note = "sent to another Command Post, which did not answer";
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

std::string describe_move(const std::string& post, const std::string& before) {
  return "the Command Post is at " + post + ", it was at " + before;
}

}  // namespace

void RunChanges::prepare_move(const std::string& post, Time time) {
  const Run& run = account_.run();
  account_.set_next_run(0);
  if (post != run.post) {
    const Run* const known = account_.runs().latest_at(post);
    if (known != nullptr) return account_.set_next_run(known->number);
    account_.announce(describe_move(post, run.post), post, time);
    return;
  }
  std::vector<Report> steps;
  for (const std::int64_t number : book_.waiting()) {
    const Run* const meant = account_.runs().find(book_.at(number).run);
    if (meant == nullptr || meant->was_heard() || meant == &run) continue;
    steps.push_back(transfer_report(book_.at(number), run.number, time));
    review_.compare_later(number);
  }
  if (!steps.empty()) book_.change(steps, run);
}

void RunChanges::change_command_post(const std::string& post, Time time) {
  const std::string from = account_.run().post;
  const Run* const known = account_.runs().latest_at(post);
  const std::int64_t next = known != nullptr ? known->number : account_.runs().next_number();
  std::vector<Report> steps;
  for (const std::int64_t number : book_.waiting()) {
    const Report& report = book_.at(number);
    const Run* const meant = account_.runs().find(report.run);
    if (meant != nullptr && !meant->was_heard()) {
      steps.push_back(transfer_report(report, next, time));
    } else if (meant == &account_.run() && !from.empty()) {
      Report& kept = steps.emplace_back(report);
      kept.changed = time.stamp;
      kept.note = "kept for the Command Post at " + from;
    }
  }
  const std::vector<const Report*> doubts = doubts_.all();
  if (known != nullptr) {
    account_.adopt(next, steps, time);
  } else {
    account_.begin({describe_move(post, from), {}}, 0, std::nullopt, steps, time);
  }
  doubts_.begin_run(doubts, time);
}

void RunChanges::detect_change(const icd::RunStatus& status, Time time) {
  judge_name(status, time);
  const auto another = account_.another(status, time);
  const Run& run = account_.run();
  if (!another) {
    if (!account_.is_grant(status, time)) return;
    // In a run that only seems to be another one, the count agrees with the sign before.
    if (run.may_be != 0) account_.add_signs({.count = true});
    account_.grant();
    return doubts_.leave_to_operator(
        icd::sentence("the reports left went up from ", run.last->remaining_reports, " to ",
                      status.remaining_reports, " while it was in doubt"),
        time);
  }
  const bool other_team = run.last && are_other_teams(run.last->current_team, status.current_team);
  const Run* const known = other_team ? account_.find_by_team(status.current_team) : nullptr;
  if (known == nullptr) return begin(*another, run.number, status, time);
  const auto differs = another_run(*known, status, {account_.seconds_between(known->heard, time.stamp)});
  if (!differs) return adopt(*known, another->why, time);
  begin({another->why, differs->signs}, known->number, status, time);
}

/// The first status after an answer with another name.
void RunChanges::judge_name(const icd::RunStatus& status, Time time) {
  const Run& run = account_.run();
  if (!run.signs.name || run.may_be == 0 || run.last) return;
  const Run* const before = account_.find_possible_run([](const Run& each) { return each.last.has_value(); });
  const NameCheck check = before == nullptr ? NameCheck::Unknown : account_.check_name(*before, status, time);
  if (check == NameCheck::Unknown) return;
  if (check == NameCheck::Confirmed) {
    account_.exclude(before->number);
    return clear_held(time);
  }
  const std::string why = icd::sentence(run.why, "; but its count of reports and its clock go on");
  return_to(*before, Repeats::StayHeld, time);
  account_.distrust_names(why);
}

/// A nameless answer has only its clock. A name outranks it, unless the Command Post renames its run.
void RunChanges::detect_change(const icd::ReportReply& reply, Time time) {
  icd::ReportReply evidence = reply;
  if (!account_.runs().name_trouble().empty()) evidence.run.clear();
  const std::string& name = evidence.run;
  if (const auto another = account_.another(evidence, time)) {
    return another->signs.name ? detect_name(name, *another, time)
                               : begin(*another, account_.run().number, std::nullopt, time);
  }
  if (name.empty() || !account_.run().id.empty()) return;
  const Run* const before = account_.find_possible_run([](const Run& run) { return !run.id.empty(); });
  if (before == nullptr) return claim(name, time);
  if (before->id != name) {
    // A referee set the clock of a run that gets another name with each answer.
    if (account_.signs_against(*before).is_clock_alone() && !account_.can_have_begun_since(*before)) return;
    account_.exclude(before->number);
    return claim(name, time);
  }
  // Some servers give all runs one name.
  account_.signs_against(*before).agree() ? give_back(*before, time)
                                          : return_to(*before, Repeats::Join, time);
}

/// The present run has another name.
void RunChanges::detect_name(const std::string& name, const AnotherRun& another, Time time) {
  const Run* const maybe = account_.find_possible_run([&name](const Run& run) { return run.id == name; });
  if (maybe != nullptr && !account_.signs_against(*maybe).agree()) {
    return return_to(*maybe, Repeats::Join, time);
  }
  const Run* const known = maybe == nullptr ? account_.find_by_name(name) : nullptr;
  known != nullptr ? adopt(*known, another.why, time)
                   : begin(another, account_.run().number, std::nullopt, time);
}

/// Queued reports are held, young ones go on into the new run. Either run may have recorded a doubt that was
/// sent around the last status, so it enters the new one.
std::vector<Report> RunChanges::steps_to(std::int64_t next, const std::string& why, Time time) {
  const std::chrono::duration<double> late = doubts_.doubt_for() + WaitingClients::kYoung;
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
  keep_held(steps);
  // The operator decides about these, even if the run goes on.
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
    const Run* const its = account_.find_by_name(other);
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

/// The present run seems to be `earlier`, or to have its name: reports that either of them may have recorded
/// belong to `earlier`, so that repeats of them stay held.
void RunChanges::give_back(const Run& earlier, Time time) {
  std::vector<Report> steps;
  for (const auto& [number, report] : book_.all()) {
    if (!account_.is_unclaimed(report)) continue;
    Report& changed = steps.emplace_back(report);
    changed.run = earlier.number;
    changed.changed = time.stamp;
  }
  if (!steps.empty()) book_.change(steps, account_.run());
}

void RunChanges::begin(const AnotherRun& another, std::int64_t may_be,
                       const std::optional<icd::RunStatus>& status, Time time) {
  const auto doubts = doubts_.all();
  const std::int64_t next = account_.runs().next_number();
  auto steps = steps_to(next, another.why, time);
  // Either run may have recorded reports that were answered since the last status.
  for (const auto& [number, report] : book_.all()) {
    const bool since = report.state == ReportState::Answered && report.changed > account_.status_at();
    if (status && report.run == account_.run().number && since) steps.emplace_back(report).run = next;
  }
  account_.begin(another, may_be, status, steps, time);
  doubts_.begin_run(doubts, time);
}

void RunChanges::adopt(const Run& known, const std::string& why, Time time) {
  const std::int64_t number = known.number;
  const auto doubts = doubts_.all();
  const auto steps = steps_to(number, why, time);
  account_.adopt(number, steps, time);
  doubts_.begin_run(doubts, time);
}

/// The present run is `known`, and so are the runs between them: all their reports move there, and reports
/// that were held for another run are queued again. Joined repeats get the originals' answers.
void RunChanges::return_to(const Run& known, Repeats held, Time time) {
  const std::int64_t number = known.number;
  const auto maybe = account_.runs().possible_runs();
  const std::set<std::int64_t> merged(maybe.begin(), std::ranges::find(maybe, number));
  const Signs signs = account_.signs_against(known);
  const auto has_blurred_counts = [&](const Report& report) {
    return report.state == ReportState::InDoubt && (report.run != number || signs.count || signs.score);
  };
  // A repeat may have been sent in the run that seemed to begin: then the operator decides.
  const auto has_twin = [&](const Report& report) {
    return std::ranges::any_of(book_.find_same(report.report), [&](const Report* other) {
      const bool stays = other->state == ReportState::Held || other->state == ReportState::Withdrawn;
      return other->number != report.number && !stays &&
             (other->run == number || merged.contains(other->run));
    });
  };
  std::vector<Report> steps;
  std::vector<std::int64_t> repeats;
  for (const auto& [each, report] : book_.all()) {
    if (report.run != number && !merged.contains(report.run)) continue;
    const bool is_released = is_held_for_run(report) && !has_twin(report);
    if (report.run == number && !is_released && !has_blurred_counts(report)) continue;
    Report& changed = steps.emplace_back(report);
    changed.run = number;
    changed.changed = time.stamp;
    if (has_blurred_counts(report)) changed.before.reset();
    if (is_released) {
      changed.state = transition(report.state, ReportEvent::Cleared)->to;
      changed.note = "the run goes on";
    }
    if (changed.state == ReportState::Queued) review_.compare_later(each);
    if (held == Repeats::StayHeld || !is_held_as_repeat(report)) continue;
    const std::int64_t its_run = book_.at(report.same_as).run;
    if (its_run != number && !merged.contains(its_run)) continue;
    changed = joined_repeat(changed, time);
    repeats.push_back(each);
  }
  account_.merge_into(number, steps, time);
  hand_over(repeats);
  doubts_.begin(time.now);
}

void RunChanges::keep_held(const std::vector<Report>& steps) {
  for (const Report& step : steps) {
    if (step.state == ReportState::Held) held_[step.number] = step.changed;
  }
}

bool RunChanges::is_held_for_run(const Report& report) const {
  const auto held = held_.find(report.number);
  return report.state == ReportState::Held && held != held_.end() && held->second == report.changed;
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
  if (&account_.expected_run() != &account_.run()) {
    return account_.announce(kWhy, account_.expected_run().post, time);
  }
  begin({kWhy, {}}, 0, std::nullopt, time);
  return account_.run().number;
}

}  // namespace adit::dispatch
