#include "dispatch/merged_runs.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "dispatch/run_watch.hpp"

namespace adit::dispatch {
namespace {

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
Run joined(Run here, const Run& there) {
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

}  // namespace

MergedRuns::MergedRuns(const Books& here, const Books& there, const SameReports& same, double ahead)
    : here_(here), same_(same), ahead_(ahead), here_runs_(runs_of(here)), there_runs_(runs_of(there)) {
  std::int64_t next = is_blank() ? 1 : here_runs_.next_number();
  std::int64_t turn = 0;
  for (const auto& [number, run] : here_runs_.all()) turn = std::max(turn, run.place());
  std::vector<const Run*> in_turn;
  for (const auto& [number, run] : there_runs_.all()) {
    const std::int64_t as = run_known_as(run);
    is_new_[number] = as == 0;
    if (as == 0 && is_blank()) next = number;
    numbers_[number] = as != 0 ? as : next++;
    in_turn.push_back(&run);
  }
  std::ranges::stable_sort(in_turn, {}, &Run::place);
  for (const Run* const run : in_turn) take(*run, ++turn);
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
std::int64_t MergedRuns::run_known_as(const Run& run) const {
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

void MergedRuns::take(const Run& run, std::int64_t turn) {
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
    next = joined(before != merged_.end() ? before->second : *here_runs_.find(number), next);
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

}  // namespace adit::dispatch
