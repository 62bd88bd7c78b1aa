#include "dispatch/merged_reports.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "dispatch/report.hpp"
#include "dispatch/runs.hpp"
#include "dispatch/verdicts.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// The fields that identify a report at both boxes.
auto identity_of(const Report& report) {
  const icd::Point& at = report.report.position;
  return std::tuple(report.received, report.report.type, at.x, at.y, at.z);
}

/// Reports of the first box that the spare has, and the spare's.
using SameReports = std::map<const Report*, const Report*>;

SameReports same_reports(const Books& here, const Books& there) {
  std::map<decltype(identity_of(std::declval<Report>())), const Report*> known;
  for (const Report& report : here.reports) known.emplace(identity_of(report), &report);
  SameReports same;
  for (const Report& report : there.reports) {
    if (const auto found = known.find(identity_of(report)); found != known.end())
      same.emplace(&report, found->second);
  }
  return same;
}

bool was_recorded(const Report& report) {
  return report.state == ReportState::Answered || report.state == ReportState::Settled;
}

/// True if the Command Post has it or may have it, and repeats get its answer.
bool has_effect(const Report& report) {
  const bool was_sent =
      was_recorded(report) || report.state == ReportState::InDoubt || report.state == ReportState::Sending;
  return was_sent && !effect_of(report).again;
}

/// The runs of a takeover: the first box's (`there`) with their numbers at the spare (`here`).
class MergedRuns {
 public:
  /// `same`: reports of both. `ahead`: Handover::ahead, seconds. `here` and `same` must outlive this object.
  MergedRuns(const Books& here, const Books& there, const SameReports& same, double ahead);

  /// The first box's runs by their numbers here, merged with those that the spare knew.
  const std::map<std::int64_t, Run>& runs() const { return merged_; }
  /// The number here; `there` if the first box has no such run.
  std::int64_t number_here(std::int64_t there) const;
  bool is_present_there(std::int64_t there) const { return there_runs_.present().number == there; }

  /// The number here of the first box's present run.
  std::int64_t present() const { return numbers_.at(there_runs_.present().number); }
  /// The spare's last run at the same Command Post that the first box does not know; 0: none.
  std::int64_t own() const { return own_; }
  /// True if own() is certainly not present().
  bool own_is_another() const { return own_is_another_; }
  /// True if `here` is a run of the spare that was never heard and that the first box does not know.
  bool is_unheard(std::int64_t here) const;

 private:
  bool is_blank() const;
  std::int64_t matching_run(const Run& run) const;
  void merge(const Run& run, std::int64_t turn);
  const Run* own_run() const;
  bool has_reports(std::int64_t run) const;
  void link_to_own();

  const Books& here_;
  const SameReports& same_;
  const double ahead_;
  const Runs here_runs_, there_runs_;
  std::map<std::int64_t, std::int64_t> numbers_;  // from numbers there to numbers here
  std::map<std::int64_t, bool> is_new_;           // by the number there
  std::map<std::int64_t, Run> merged_;            // by the number here
  std::int64_t own_ = 0;
  bool own_is_another_ = false;
};

bool are_told_apart(const Run& one, const Run& other) {
  const bool other_name = !one.id.empty() && !other.id.empty() && one.id != other.id;
  const bool other_team =
      one.last && other.last && are_other_teams(one.last->current_team, other.last->current_team);
  return other_name || other_team;
}

Runs runs_of(const Books& books) {
  std::int64_t latest = 1;
  for (const Report& report : books.reports) latest = std::max(latest, report.run);
  Runs runs;
  runs.open(books.runs, latest);
  return runs;
}

/// The later box wins. No field becomes empty.
Run merge_run(Run here, const Run& there) {
  if (there.heard > here.heard) {
    here.heard = there.heard;
    here.last = there.last;
    here.status_clock = there.status_clock;
    here.answer_clock = there.answer_clock;
  }
  if (here.id.empty()) here.id = there.id;
  if (here.unreliable.empty()) here.unreliable = there.unreliable;
  if (here.name_trouble.empty()) here.name_trouble = there.name_trouble;
  return here;
}

MergedRuns::MergedRuns(const Books& here, const Books& there, const SameReports& same, double ahead)
    : here_(here), same_(same), ahead_(ahead), here_runs_(runs_of(here)), there_runs_(runs_of(there)) {
  std::int64_t next = is_blank() ? 1 : here_runs_.next_number();
  std::int64_t turn = 0;
  for (const auto& [number, run] : here_runs_.all()) turn = std::max(turn, run.place());
  std::vector<const Run*> in_turn;
  for (const auto& [number, run] : there_runs_.all()) {
    const std::int64_t as = matching_run(run);
    is_new_[number] = as == 0;
    if (as == 0 && is_blank()) next = number;
    numbers_[number] = as != 0 ? as : next++;
    in_turn.push_back(&run);
  }
  std::ranges::stable_sort(in_turn, {}, &Run::place);
  for (const Run* const run : in_turn) merge(*run, ++turn);
  link_to_own();
}

std::int64_t MergedRuns::number_here(std::int64_t there) const {
  const auto found = numbers_.find(there);
  return found == numbers_.end() ? there : found->second;
}

bool MergedRuns::is_unheard(std::int64_t here) const {
  const Run* const run = here_runs_.find(here);
  return run != nullptr && !run->was_heard() && !merged_.contains(here);
}

/// No report and no heard run: the first box's numbers stay.
bool MergedRuns::is_blank() const {
  return here_.reports.empty() && std::ranges::none_of(here_.runs, &Run::was_heard);
}

/// By common reports, or by address and begin. 0: unknown here.
std::int64_t MergedRuns::matching_run(const Run& run) const {
  std::int64_t found = 0;
  for (const auto& [there, here] : same_) {
    const Run* const known = there->run == run.number ? here_runs_.find(here->run) : nullptr;
    if (known != nullptr && (found == 0 || known->place() > here_runs_.find(found)->place()))
      found = here->run;
  }
  if (found != 0) return found;
  // First runs have no begin.
  const auto is_it = [&run](const Run& here) {
    return here.post == run.post && here.began == run.began && here.why == run.why &&
           (run.began != 0 || (here.last == run.last && here.id == run.id));
  };
  const auto same = std::ranges::find_if(here_.runs, is_it);
  return same == here_.runs.end() ? 0 : same->number;
}

void MergedRuns::merge(const Run& run, std::int64_t turn) {
  const std::int64_t number = numbers_.at(run.number);
  Run next = run;
  if (run.heard != 0) next.heard += ahead_;
  if (is_new_.at(run.number)) {
    next.number = number;
    next.turn = turn;
    const auto may_be = numbers_.find(run.may_be);
    next.may_be = may_be == numbers_.end() ? 0 : may_be->second;
  } else {
    const auto before = merged_.find(number);
    next = merge_run(before != merged_.end() ? before->second : *here_runs_.find(number), next);
    const bool is_present_already = here_runs_.present().number == number;
    if (is_present_there(run.number) && !is_present_already) next.turn = turn;
  }
  merged_[number] = std::move(next);
}

/// own(), or null.
const Run* MergedRuns::own_run() const {
  const Run& last = merged_.at(present());
  const Run* own = nullptr;
  for (const auto& [number, run] : here_runs_.all()) {
    const bool is_there = run.post == last.post && !merged_.contains(number);
    const bool counts = run.was_heard() || has_reports(number);
    if (is_there && counts && (own == nullptr || run.place() > own->place())) own = &run;
  }
  return own;
}

bool MergedRuns::has_reports(std::int64_t run) const {
  return std::ranges::find(here_.reports, run, &Report::run) != here_.reports.end();
}

/// The first box's present run may be the spare's own.
void MergedRuns::link_to_own() {
  const Run* const own = own_run();
  if (own == nullptr || !is_new_.at(there_runs_.present().number)) return;
  own_ = own->number;
  own_is_another_ = are_told_apart(*own, merged_.at(present()));
  if (own_is_another_) return;
  Run* first = &merged_.at(present());
  while (first->may_be != 0 && merged_.contains(first->may_be)) first = &merged_.at(first->may_be);
  if (first->may_be == 0 && own_ < first->number) first->may_be = own_;
}

class MergedReports {
 public:
  MergedReports(const Books& here, const Books& there, const Handover& handover)
      : here_(here),
        there_(there),
        handover_(handover),
        same_(same_reports(here, there)),
        runs_(here, there, same_, handover.ahead) {
    for (const Report& report : here_.reports) {
      next_number_ = std::max(next_number_, report.number + 1);
      sendings_here_ = std::max(sendings_here_, report.sending);
      next_sending_ = std::max(next_sending_, report.sending);
    }
    for (const Report& report : there_.reports)
      next_sending_ = std::max(next_sending_, sendings_here_ + report.sending);
  }

  TakeoverChanges run() {
    for (const auto& [number, run] : runs_.runs()) result_.runs.push_back(run);
    for (const Report& report : there_.reports) number(report);
    for (const Report& report : there_.reports) merge(report);
    std::set<const Report*> met;
    for (const auto& [there, here] : same_) met.insert(here);
    for (const Report& report : here_.reports) {
      if (!met.contains(&report)) move_own_report(report);
    }
    return std::move(result_);
  }

 private:
  const Report* find_known(const Report& report) const {
    const auto found = same_.find(&report);
    return found == same_.end() ? nullptr : found->second;
  }

  void number(const Report& report) {
    const Report* const here = find_known(report);
    if (here == nullptr && here_.reports.empty()) next_number_ = report.number;
    numbers_[report.number] = here != nullptr ? here->number : next_number_++;
  }

  Report renumber(const Report& report) const {
    Report next = report;
    next.number = numbers_.at(report.number);
    next.run = runs_.number_here(report.run);
    const auto same = numbers_.find(report.same_as);
    next.same_as = same == numbers_.end() ? 0 : same->second;
    if (report.sending != 0) next.sending = sendings_here_ + report.sending;
    if (report.sent != 0) next.sent += handover_.ahead;
    return next;
  }

  void merge(const Report& report) {
    const Report* const here = find_known(report);
    if (here != nullptr && !is_better(report, *here)) return;
    Report next = renumber(report);
    const bool has_stepped = move(next, report) || here != nullptr;
    result_.reports.push_back({.report = std::move(next),
                               .there = here == nullptr ? report.number : 0,
                               .has_stepped = has_stepped});
  }

  /// True if the first box knows more about the report.
  static bool is_better(const Report& there, const Report& here) {
    // Lost reports cannot be told apart.
    if (was_recorded(here) || here.is_lost()) return false;
    return was_recorded(there) || there.changed > here.changed;
  }

  /// Applies the change of boxes. False: no change.
  bool move(Report& next, const Report& there) {
    if (there.state == ReportState::Sending) {
      ++next.tries;
      return step(next, ReportState::InDoubt, "the first box stopped while it was in flight");
    }
    if (there.state != ReportState::Queued) return false;
    if (const Report* const own = sent_here(next); own != nullptr) {
      next.same_as = own->number;
      return step(next, ReportState::Held,
                  icd::sentence("the same as report ", own->number, ", which this box had"));
    }
    next.before = runs_.is_present_there(there.run) ? handover_.expected : std::nullopt;
    next.beside = 0;
    next.counted = false;
    next.sending = ++next_sending_;
    next.sent = handover_.stamp;
    return step(next, ReportState::InDoubt, "queued at the first box, which may have sent it since");
  }

  bool step(Report& report, ReportState state, const std::string& note) const {
    report.state = state;
    report.note = note;
    report.changed = handover_.stamp;
    return true;
  }

  /// The same report that this box may have sent in the first box's present run, or null.
  const Report* sent_here(const Report& report) const {
    if (runs_.own() == 0 || runs_.own_is_another() || report.run != runs_.present() || report.asked)
      return nullptr;
    for (const Report& own : here_.reports) {
      if (own.run == runs_.own() && has_effect(own) && is_same(own.report, report.report)) return &own;
    }
    return nullptr;
  }

  /// A report queued here belongs to the present run, which the first box knew.
  void move_own_report(const Report& own) {
    const bool is_of_own = runs_.own() != 0 && own.run == runs_.own();
    if (own.state != ReportState::Queued || (!is_of_own && !runs_.is_unheard(own.run))) return;
    Report next = own;
    if (is_of_own && runs_.own_is_another()) {
      step(next, ReportState::Held, "the run of the first box goes on");
    } else if (const TakenOverReport* const same = find_equal(own); same != nullptr && !own.asked) {
      next.run = runs_.present();
      next.same_as = same->report.number;
      step(next, ReportState::Held,
           icd::sentence("the same as report ", same->report.number, ", which the first box had"));
    } else {
      next.run = runs_.present();
      step(next, ReportState::Queued, "");
    }
    result_.reports.push_back({.report = std::move(next), .there = 0, .has_stepped = true});
  }

  const TakenOverReport* find_equal(const Report& own) const {
    const auto is_like = [&](const TakenOverReport& taken) {
      return taken.there != 0 && taken.report.run == runs_.present() &&
             (has_effect(taken.report) || taken.report.is_corrected()) &&
             is_same(taken.report.report, own.report);
    };
    const auto found = std::ranges::find_if(result_.reports, is_like);
    return found == result_.reports.end() ? nullptr : &*found;
  }

  const Books& here_;
  const Books& there_;
  const Handover& handover_;
  const SameReports same_;
  const MergedRuns runs_;
  std::map<std::int64_t, std::int64_t> numbers_;  // of reports, from there to here
  std::int64_t next_number_ = 1, sendings_here_ = 0, next_sending_ = 0;
  TakeoverChanges result_;
};

}  // namespace

TakeoverChanges take_over(const Books& here, const Books& there, const Handover& handover) {
  return MergedReports(here, there, handover).run();
}

}  // namespace adit::dispatch
