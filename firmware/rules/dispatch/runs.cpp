#include "dispatch/runs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

/// The sign of a clock, as a sentence, or "". `is_alone`: without another sign, the clock must have run.
std::string clock_sign(const std::optional<Clock>& clock, double shows, double silence, bool is_alone) {
  if (!clock || (!clock->runs && is_alone)) return "";
  const double before = clock->shows;
  if (shows < before - kClockJitter) {
    return icd::sentence("the run clock went back from ", before, " s to ", shows, " s");
  }
  // At 0 the run has not started, and the clock may stand.
  if (clock->runs && before > 0 && silence > kShortSilence && shows - before < silence / 2) {
    return icd::sentence("after ", static_cast<std::int64_t>(silence),
                         " s of silence the run clock was only ", static_cast<std::int64_t>(shows - before),
                         " s ahead");
  }
  return "";
}

/// Before a run starts, the Command Post may set its counts to any value.
bool has_started(const Run& run) {
  return run.last->run_clock > 0 || (run.answer_clock && run.answer_clock->shows > 0);
}

bool is_count_up(const Run& run, const icd::RunStatus& status) {
  return has_started(run) && status.remaining_reports > run.last->remaining_reports;
}

bool is_score_back(const Run& run, const icd::RunStatus& status) {
  return has_started(run) && status.score < run.last->score;
}

/// Without a status of both, the operator has decided.
bool are_certainly_different(const Run& before, const Run& now) {
  const bool are_heard = before.last && now.last;
  const bool is_clock_back = are_heard && now.last->run_clock < before.last->run_clock - kClockJitter;
  if (are_heard && are_other_teams(before.last->current_team, now.last->current_team)) return true;
  if (now.may_be != 0) return now.signs.count && is_clock_back;
  if (!before.id.empty() && !now.id.empty()) return before.id != now.id;
  return !are_heard || is_clock_back;
}

}  // namespace

bool can_be_new(double shows, double ago) {
  return shows <= ago + kClockJitter;
}

bool are_other_teams(const std::string& one, const std::string& other) {
  return !one.empty() && !other.empty() && one != other;
}

std::optional<AnotherRun> another_run(const Run& run, const icd::RunStatus& status, const Silence& silence) {
  if (!run.last) return std::nullopt;
  if (are_other_teams(status.current_team, run.last->current_team)) {
    return AnotherRun{icd::sentence("the team is ", icd::quote_text(status.current_team), ", it was ",
                                    icd::quote_text(run.last->current_team)),
                      {}};
  }
  Signs signs{.count = is_count_up(run, status), .score = is_score_back(run, status)};
  std::string why =
      clock_sign(run.status_clock, status.run_clock, silence.at_least, !signs.count && !signs.score);
  signs.clock = !why.empty();
  if (!signs.agree() && has_continued(run, status, silence)) return std::nullopt;
  const auto add = [&why](const std::string& more) { why += (why.empty() ? "" : " and ") + more; };
  if (signs.score) add(icd::sentence("the score fell from ", run.last->score, " to ", status.score));
  if (signs.count) {
    add(icd::sentence("the reports left went up from ", run.last->remaining_reports, " to ",
                      status.remaining_reports));
  }
  return signs.is_any() ? std::optional(AnotherRun{why, signs}) : std::nullopt;
}

std::optional<AnotherRun> another_run(const Run& run, const icd::ReportReply& reply, const Silence& silence) {
  if (!run.id.empty() && !reply.run.empty()) {
    if (run.id == reply.run) return std::nullopt;
    return AnotherRun{icd::sentence("the Command Post calls it run ", icd::quote_text(reply.run), ", it was ",
                                    icd::quote_text(run.id)),
                      {.name = true}};
  }
  if (reply.run_clock <= 0) return std::nullopt;  // no clock
  const std::string why = clock_sign(run.answer_clock, reply.run_clock, silence.at_least, true);
  return why.empty() ? std::nullopt : std::optional(AnotherRun{why, {.clock = true}});
}

bool has_continued(const Run& run, const icd::RunStatus& status, const Silence& silence) {
  if (!run.status_clock || !silence.since_status || *silence.since_status > kShortSilence) return false;
  const double passed = *silence.since_status;
  const double advanced = status.run_clock - run.status_clock->shows;
  const bool is_on_time =
      advanced > 0 && advanced >= passed / 2 && std::abs(advanced - passed) <= kClockJitter;
  return is_on_time && !can_be_new(status.run_clock, passed);
}

bool is_grant(const Run& run, const icd::RunStatus& status, const Silence& silence) {
  return run.last && is_count_up(run, status) && !is_score_back(run, status) &&
         has_continued(run, status, silence);
}

NameCheck check_name(const Run& before, const icd::RunStatus& status, const Silence& silence) {
  const bool is_young =
      can_be_new(status.run_clock, silence.since_status.value_or(silence.at_least + kClockAhead));
  if (const auto another = another_run(before, status, silence)) {
    return another->signs.is_clock_alone() && !is_young ? NameCheck::Unknown : NameCheck::Confirmed;
  }
  if (before.status_clock && before.status_clock->runs) {
    if (!is_young) return NameCheck::Contradicted;
    return silence.since_status ? NameCheck::Confirmed : NameCheck::Unknown;
  }
  // A clock that stands says nothing. In another run, the count would hardly continue to fall.
  const bool falls = status.remaining_reports < before.last->remaining_reports;
  return falls ? NameCheck::Contradicted : NameCheck::Unknown;
}

bool can_show_other_run(const Run& run) {
  return run.status_clock && run.status_clock->runs;
}

NextMap next_map(const Run& before, const Run& now) {
  if (!are_certainly_different(before, now)) return NextMap::MayBeTheSame;
  return now.began >= before.heard ? NextMap::Empty : NextMap::Earlier;
}

void Runs::open(std::vector<Run> all, std::int64_t latest) {
  runs_.clear();
  for (Run& run : all) runs_[run.number] = std::move(run);
  if (runs_.empty() || runs_.rbegin()->first < latest) runs_[latest] = {.number = latest};
  // The last run is the present one if it has no turn.
  present_ = runs_.rbegin()->first;
  if (runs_.at(present_).turn == 0) return adopt(present_);
  present_ = std::ranges::max_element(runs_, {}, [](const auto& item) { return item.second.place(); })->first;
}

const Run* Runs::find(std::int64_t number) const {
  const auto found = runs_.find(number);
  return found == runs_.end() ? nullptr : &found->second;
}

const Run* Runs::latest(const std::function<bool(const Run&)>& fits) const {
  const Run* found = nullptr;
  for (const auto& [number, run] : runs_) {
    if (number == present_ || !fits(run)) continue;
    if (found == nullptr || run.place() > found->place()) found = &run;
  }
  return found;
}

const Run* Runs::latest_at(const std::string& post) const {
  return latest([&post](const Run& run) { return run.post == post; });
}

std::int64_t Runs::next_turn() const {
  std::int64_t last = 0;
  for (const auto& [number, run] : runs_) last = std::max(last, run.place());
  return last + 1;
}

void Runs::begin(Run run) {
  run.number = next_number();
  run.turn = next_turn();
  present_ = run.number;
  runs_[present_] = std::move(run);
}

void Runs::adopt(std::int64_t number) {
  runs_.at(number).turn = next_turn();
  present_ = number;
}

bool Runs::is_at(std::int64_t number, const std::string& post) const {
  const Run* const run = find(number);
  return run == nullptr || run->post.empty() || run->post == post;
}

std::vector<std::int64_t> Runs::possible_runs(std::int64_t number) const {
  std::vector<std::int64_t> numbers;
  // The last condition ends a damaged chain.
  for (const Run* run = find(number); run != nullptr;) {
    numbers.push_back(run->number);
    run = run->may_be != 0 && run->may_be < run->number ? find(run->may_be) : nullptr;
  }
  return numbers;
}

const std::string& Runs::name_trouble() const {
  for (const std::int64_t number : possible_runs()) {
    const Run& run = runs_.at(number);
    if (!run.name_trouble.empty()) return run.name_trouble;
  }
  return present().name_trouble;
}

bool Runs::can_be(std::int64_t number, std::int64_t other) const {
  const auto numbers = possible_runs(number);
  return std::ranges::find(numbers, other) != numbers.end();
}

const Run& Runs::exclude(std::int64_t number) {
  Run* later = &present();
  while (later->may_be != number) later = &runs_.at(later->may_be);
  later->may_be = 0;
  return *later;
}

}  // namespace adit::dispatch
