#include "dispatch/run_account.hpp"

#include <algorithm>
#include <utility>

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

// Why counts may not fit the reports.
const std::string kCorrected = "the counts may have been corrected: ";
const std::string kOtherSender = "another sender may report with this token: ";

/// "went from 20 to 18", "stayed 20"
std::string change(std::int64_t before, std::int64_t now) {
  return before == now ? icd::sentence("stayed ", now) : icd::sentence("went from ", before, " to ", now);
}

/// "reports left went from 20 to 18, the score stayed 3, with 2 reports in doubt"
std::string figures(const icd::RunStatus& before, std::int64_t doubts, std::int64_t beside,
                    const LaterReports& since, const icd::RunStatus& now) {
  std::string text = icd::sentence("reports left ", change(before.remaining_reports, now.remaining_reports),
                                   ", the score ", change(before.score, now.score));
  if (since.scored > 0) text += icd::sentence(", ", since.scored, " of it by reports sent since");
  if (doubts > 1) text += icd::sentence(", with ", doubts, " reports in doubt");
  if (beside > 0) {
    text += icd::sentence("; ", beside, beside > 1 ? " other reports" : " other report",
                          " in doubt may explain it");
  }
  return text;
}

}  // namespace

Evidence weigh(const icd::RunStatus& before, std::int64_t doubts, std::int64_t beside,
               const LaterReports& since, const icd::RunStatus& now) {
  const std::int64_t all = doubts + beside;
  const std::int64_t used = before.remaining_reports - since.scored - now.remaining_reports;
  const std::int64_t points = now.score - before.score - since.points;
  const std::string seen = figures(before, doubts, used > 0 ? beside : 0, since, now);
  if (before.run_clock <= 0 && (used != 0 || points != 0)) {
    return {Finding::Silent, "before a run starts, the counts show no report: " + seen, {}};
  }
  if (used < 0 || used > all || points < 0 || points > used + since.unclear) {
    const bool is_corrected = used < 0 || points < 0;  // no report does that
    return {Finding::Contradicts, (is_corrected ? kCorrected : kOtherSender) + seen, {}};
  }
  // Then the counts do not show a record.
  if (used == 0 && (before.remaining_reports - since.scored <= 0 || now.run_clock <= 0)) {
    return {Finding::Silent, "the counts cannot show a report now: " + seen, {}};
  }
  if (used == 0) return {Finding::NotRecorded, seen, {}};
  if (used < all) return {Finding::Silent, "the counts do not show which of them was recorded: " + seen, {}};
  const bool alike = points == 0 || points == all + since.unclear;
  return {Finding::Recorded, seen, alike ? std::optional<std::int64_t>(points > 0 ? 1 : 0) : std::nullopt};
}

Finding Inquiry::add_evidence(const Evidence& evidence, double run_clock, Instant asked, Instant now) {
  Finding finding = evidence.finding;
  if (finding == Finding::NotRecorded && is_stalled(run_clock, now)) finding = Finding::Silent;
  if (!first_heard_) {
    first_heard_ = now;
    first_clock_ = run_clock;
  }
  last_heard_ = now;
  agreeing_ = finding == finding_ ? agreeing_ + 1 : 1;
  finding_ = finding;
  in_vain_ = !is_pending(now);
  if (finding == Finding::Recorded && agreeing_ < kRecordedAsks) return Finding::Silent;
  const bool late_enough = asked - lost_ >= policy_.doubt_for && agreeing_ >= policy_.asks;
  if (finding == Finding::NotRecorded && !late_enough) return Finding::Silent;
  return finding;
}

/// In an administrative stop (ICD 5.2) the clock stands, and the counts do not show reports.
bool Inquiry::is_stalled(double run_clock, Instant now) const {
  if (!first_heard_) return false;
  constexpr std::chrono::duration<double> kTooShort{0.2};  // two answers may take unequal times
  constexpr double kRuns = 0.25;  // a running clock shows at least this part of the elapsed time
  const std::chrono::duration<double> elapsed = now - *first_heard_;
  return elapsed > kTooShort && run_clock - first_clock_ < elapsed.count() * kRuns;
}

Instant Inquiry::next_ask(Instant now) const {
  if (!asked_) return now;
  return *asked_ + (in_vain_ ? policy_.doubt_for : policy_.doubt_for / 10);
}

bool Inquiry::is_pending(Instant now) const {
  if (now < lost_ + policy_.doubt_for * 3 / 2) return true;
  const bool speaks = finding_ == Finding::Recorded || finding_ == Finding::NotRecorded;
  return speaks && now < *last_heard_ + policy_.doubt_for / 2;
}

namespace {

/// Seconds; the last write may be of an answer.
constexpr double kAnswerWritten = 1;

}  // namespace

void RunAccount::set_spacing(Instant::duration spacing) {
  fresh_ = std::max<Instant::duration>(kFresh, spacing * 5 / 4 + std::chrono::seconds(1));
}

void RunAccount::open(std::vector<Run> all, std::int64_t latest, const std::string& post) {
  runs_.open(std::move(all), latest);
  written_ = run().heard;
  status_at_ = run().heard - kAnswerWritten;
  post_ = post.empty() ? run().post : post;
  if (post.empty() || !run().post.empty()) return;
  runs_.present().post = post;
  book_.write(run());  // before its reports: without an address they would count as the next Command Post's
}

bool RunAccount::is_of_run(const Report& report) const {
  return report.run == expected_run().number || report.state == ReportState::Sending;
}

bool RunAccount::is_unclaimed(const Report& report) const {
  return report.run == run().number && report.state == ReportState::Answered &&
         report.changed < run().began && run().id.empty();
}

std::vector<std::int64_t> RunAccount::waiting_at(const std::string& post) const {
  std::vector<std::int64_t> there;
  for (const std::int64_t number : book_.waiting()) {
    if (runs_.is_at(book_.at(number).run, post)) there.push_back(number);
  }
  return there;
}

std::optional<icd::RunStatus> RunAccount::expected_status(Instant now) const {
  if (!known_ || odd_ || unscored_ || !run().unreliable.empty()) return std::nullopt;
  icd::RunStatus status = known_->status;
  status.remaining_reports -= known_->since.scored;
  status.score += known_->since.points;
  if (status.run_clock > 0) status.run_clock += std::chrono::duration<double>(now - known_->heard).count();
  return status;
}

std::optional<AnotherRun> RunAccount::another(const icd::RunStatus& status, Time time) const {
  return another_run(run(), status, silence(time));
}

std::optional<AnotherRun> RunAccount::another(const icd::ReportReply& reply, Time time) const {
  return another_run(run(), reply, silence(time));
}

bool RunAccount::is_grant(const icd::RunStatus& status, Time time) const {
  return dispatch::is_grant(run(), status, silence(time));
}

NameCheck RunAccount::check_name(const Run& before, const icd::RunStatus& status, Time time) const {
  return dispatch::check_name(before, status, {silence_of(before, time), silence(time).since_status});
}

const Run* RunAccount::find_by_team(const std::string& team) const {
  return runs_.latest([&](const Run& run) {
    return run.post == post_ && run.last && !team.empty() && run.last->current_team == team;
  });
}

const Run* RunAccount::find_by_name(const std::string& id) const {
  return runs_.latest([&](const Run& other) {
    const bool other_team =
        run().last && other.last && are_other_teams(run().last->current_team, other.last->current_team);
    return other.post == post_ && other.id == id && !other_team;
  });
}

const Run* RunAccount::find_possible_run(const std::function<bool(const Run&)>& fits) const {
  for (const std::int64_t number : runs_.possible_runs()) {
    const Run* const each = runs_.find(number);
    if (each != &run() && fits(*each)) return each;
  }
  return nullptr;
}

Signs RunAccount::signs_against(const Run& earlier) const {
  Signs signs;
  for (const std::int64_t number : runs_.possible_runs()) {
    if (number == earlier.number) break;
    signs |= runs_.find(number)->signs;
  }
  return signs;
}

bool RunAccount::can_have_begun_since(const Run& earlier) const {
  return !run().last || can_be_new(run().last->run_clock, seconds_between(earlier.heard, run().heard));
}

/// By stamps, less the step and the possible lead after a boot.
double RunAccount::silence_of(const Run& run, Time time) const {
  return std::max(0.0, clock_step_.seconds_between(run.heard, time.stamp) - kClockAhead);
}

/// In one process by the monotonic clock.
Silence RunAccount::silence(Time time) const {
  const auto since = [&time](Instant last) { return std::chrono::duration<double>(time.now - last).count(); };
  Silence silence;
  if (status_came_) silence.since_status = since(*status_came_);
  silence.at_least = clock_at_ ? since(*clock_at_) : silence_of(run(), time);
  return silence;
}

void RunAccount::begin(const AnotherRun& another, std::int64_t may_be,
                       const std::optional<icd::RunStatus>& status, std::span<const Report> steps,
                       Time time) {
  Run next{.began = time.stamp,
           .why = another.why,
           .last = status,
           .heard = time.stamp,
           .post = post_,
           .may_be = another.signs.is_any() ? may_be : 0,
           .signs = another.signs};
  if (status) next.status_clock = Clock{.shows = status->run_clock};
  runs_.begin(std::move(next));
  status_at_ = time.stamp;
  clock_at_ = time.now;
  forget_counts();
  book_.change(steps, run());
  written_ = time.stamp;
}

std::int64_t RunAccount::announce(const std::string& why, const std::string& post, Time time) {
  const std::int64_t present = run().number;
  runs_.begin({.began = time.stamp, .why = why, .heard = time.stamp, .post = post});
  const Run next = run();
  runs_.adopt(present);
  runs_.set_next_run(next.number);
  book_.write(run());  // first, so that the other run is never the last on disk
  book_.write(next);
  written_ = time.stamp;
  return next.number;
}

void RunAccount::adopt(std::int64_t number, std::span<const Report> steps, Time time) {
  runs_.adopt(number);
  status_at_ = run().heard - kAnswerWritten;
  clock_at_.reset();
  status_came_.reset();
  forget_counts();
  book_.change(steps, run());
  written_ = time.stamp;
}

void RunAccount::merge_into(std::int64_t number, std::span<const Report> steps, Time time) {
  const auto numbers = runs_.possible_runs();  // from the latest to the earliest
  Run merged = *runs_.find(number);
  for (auto each = std::ranges::find(numbers, number); each != numbers.begin();) {
    const Run& later = *runs_.find(*--each);
    if (later.last) {
      merged.last = later.last;
      merged.status_clock = later.status_clock;
    }
    if (later.answer_clock) merged.answer_clock = later.answer_clock;
    if (merged.unreliable.empty()) merged.unreliable = later.unreliable;
    if (merged.name_trouble.empty()) merged.name_trouble = later.name_trouble;
    merged.heard = later.heard;
  }
  runs_.adopt(number);
  merged.turn = run().turn;
  runs_.present() = std::move(merged);
  forget_counts();
  book_.change(steps, run());
  written_ = time.stamp;
}

void RunAccount::add_signs(const Signs& signs) {
  runs_.present().signs |= signs;
  book_.write(run());
}

void RunAccount::distrust_names(const std::string& why) {
  runs_.present().name_trouble = why;
  book_.write(run());
}

void RunAccount::forget_counts() {
  known_.reset();
  odd_ = unscored_ = has_moved_ = is_granted_ = false;
}

/// As in Inquiry: a running clock shows at least a quarter of the time. Before the start it stands.
bool RunAccount::is_clock_stopped(const icd::RunStatus& status, Time time) const {
  const auto& clock = run().status_clock;
  if (status.run_clock <= 0) return true;
  if (!clock || !clock->runs) return false;
  return !status_came_ || status.run_clock - clock->shows < *silence(time).since_status / 4;
}

void RunAccount::on_status(const icd::RunStatus& status, Time time) {
  is_stopped_ = is_clock_stopped(status, time);
  heard_ = clock_at_ = status_came_ = time.now;
  Run& run = runs_.present();
  // Signs of another run are written at once.
  const bool is_news = !run.last || run.last->remaining_reports != status.remaining_reports ||
                       run.last->current_team != status.current_team;
  const Clock clock = update_clock(run.status_clock, status.run_clock);
  const bool seen_to_run = clock.runs && !(run.status_clock && run.status_clock->runs);
  run.last = status;
  run.status_clock = clock;
  run.heard = status_at_ = time.stamp;
  const bool is_late = time.stamp - written_ >= kWriteEvery || time.stamp < written_;
  if (is_news || seen_to_run || is_late) write_down(time.stamp);
}

void RunAccount::on_answered(const icd::ReportReply& reply, Time time) {
  const Effect effect = effect_of(reply);
  heard_ = time.now;
  unscored_ = !effect.scored;
  Run& run = runs_.present();
  bool is_news = false;
  if (reply.run_clock > 0) {
    const Clock clock = update_clock(run.answer_clock, reply.run_clock);
    is_news = !run.answer_clock || clock.runs != run.answer_clock->runs;
    run.answer_clock = clock;
    run.heard = time.stamp;
    clock_at_ = time.now;
  }
  if (run.id.empty() && !reply.run.empty()) {
    run.id = reply.run;
    is_news = true;
  }
  if (is_news) write_down(time.stamp);
  if (!known_ || !effect.scored) return;
  ++known_->since.scored;
  known_->since.points += reply.score_change;
}

void RunAccount::forget_expected(Instant until) {
  known_.reset();
  uncertain_until_ = until;
}

void RunAccount::settle(const icd::RunStatus& status, std::int64_t open, Time time) {
  if (uncertain_until_ && time.now < *uncertain_until_) return;
  if (std::exchange(is_granted_, false)) {
    // Reports that were answered since the last status may be counted later: the next status decides.
    odd_ = known_ && known_->since.scored > 0;
    has_moved_ = true;
    known_ = {.status = status, .heard = time.now, .since = {}};
    return;
  }
  // Before a run starts, the Command Post may set its counts to any value.
  if (known_ && known_->status.run_clock > 0) {
    const std::int64_t remaining = known_->status.remaining_reports - known_->since.scored;
    const std::int64_t score = known_->status.score + known_->since.points;
    const std::int64_t used = remaining - status.remaining_reports, points = status.score - score;
    const bool fits = used >= 0 && used <= open && points >= 0 && points <= used;
    if (!fits && !odd_) {  // the count may lag: wait for the next status
      odd_ = true;
      return;
    }
    const bool moves =
        status.remaining_reports != known_->status.remaining_reports || status.score != known_->status.score;
    has_moved_ = has_moved_ || moves;
    if (!fits && !has_moved_) {
      distrust(Run::kCountsStand, time.stamp);
    } else if (!fits) {
      distrust(icd::sentence(used < 0 || points < 0 ? kCorrected : kOtherSender, "the Command Post counts ",
                             status.remaining_reports, " reports left and score ", status.score,
                             ", Adit's own reports make it ", remaining, " and ", score),
               time.stamp);
    }
  }
  odd_ = false;
  known_ = {.status = status, .heard = time.now, .since = {}};
}

void RunAccount::distrust(const std::string& why, double stamp) {
  if (!run().unreliable.empty()) return;
  runs_.present().unreliable = why;
  write_down(stamp);
}

void RunAccount::write_down(double stamp) {
  book_.write(run());
  written_ = stamp;
}

}  // namespace adit::dispatch
