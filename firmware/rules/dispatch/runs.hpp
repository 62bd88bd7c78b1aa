#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "icd/scoring.hpp"

namespace adit::dispatch {

/// A run's clock at one URI. The URIs may have different clocks, and clocks may stand.
struct Clock {
  double shows = 0;   // seconds of the run, as last heard
  bool runs = false;  // seen to advance; only then is it evidence

  friend bool operator==(const Clock&, const Clock&) = default;
};

inline Clock update_clock(const std::optional<Clock>& seen, double shows) {
  if (!seen) return {.shows = shows};
  return {.shows = shows, .runs = seen->runs || shows > seen->shows};
}

/// Signs that a run is another one than the run before it.
struct Signs {
  bool count = false;  // more reports are left
  bool clock = false;  // the clock went back, or fell behind in a silence
  bool score = false;  // the score fell
  bool name = false;   // an answer gave another name

  bool is_any() const { return count || clock || score || name; }
  /// Even the same name does not contradict them, because some servers give all runs one name.
  bool agree() const { return count + clock + score >= 2; }
  bool is_clock_alone() const { return clock && !count && !score; }
  Signs& operator|=(const Signs& more) {
    count |= more.count, clock |= more.clock, score |= more.score, name |= more.name;
    return *this;
  }
  friend bool operator==(const Signs&, const Signs&) = default;
};

/// A run of the Command Post. Its address, team and name identify it, or a difference that a status shows.
struct Run {
  /// In `unreliable`: no sign of another sender.
  static constexpr const char* kCountsStand =
      "the counts have not changed since the first report: they prove no report";

  std::int64_t number = 1;                            // Adit's own number, from 1
  std::string id = "";                                // Command Post's name (ICD 5.2 `run`); "": unknown
  double began = 0;                                   // seconds since 1970
  std::string why = "";                               // a sentence: how Adit noticed it
  std::optional<icd::RunStatus> last = std::nullopt;  // its last status
  double heard = 0;                                   // seconds since 1970
  std::string post = "";                              // the Command Post's address and port; "": unknown
  std::string unreliable = "";                        // why its counts prove no report; "": they do

  std::int64_t turn = 0;    // higher if it became the present run later; 0: by number
  std::int64_t may_be = 0;  // earlier run that it may still be, or 0
  std::optional<Clock> status_clock = std::nullopt;  // of GET /api/status
  std::optional<Clock> answer_clock = std::nullopt;  // of the answers to reports
  Signs signs = {};                                  // that it is not the run `may_be`
  std::string name_trouble = "";  // a sentence: another name was given to it, so that names prove nothing

  bool was_heard() const { return last.has_value() || !id.empty(); }
  std::int64_t place() const { return turn > number ? turn : number; }
  friend bool operator==(const Run&, const Run&) = default;
};

/// Tolerance of a run clock that goes back.
inline constexpr double kClockJitter = 1.0;  // seconds
/// A new run needs a longer silence to overtake the old run's clock unnoticed.
inline constexpr double kShortSilence = 30.0;  // seconds
/// How far the stamp clock may start ahead after a boot.
inline constexpr double kClockAhead = 170.0;  // seconds

struct AnotherRun {
  std::string why;
  Signs signs;  // none: certain, because the team is another one
};

/// Seconds without word of a run.
struct Silence {
  double at_least = 0;                                // since its last clock
  std::optional<double> since_status = std::nullopt;  // since its last status; nullopt: before this process
};

/// Whether a status, after that silence, shows another run than `run`: another team, more remaining reports,
/// a lower score, or a clock that ran and then went back or fell behind in a long silence. nullopt: it may be
/// of `run`. More reports or a lower score alone are no sign while the clock goes on (has_continued()).
std::optional<AnotherRun> another_run(const Run& run, const icd::RunStatus& status, const Silence& silence);

/// The same by an answer's `run` (ICD 5.2), or if that is missing, by its clock.
std::optional<AnotherRun> another_run(const Run& run, const icd::ReportReply& reply, const Silence& silence);

/// True if the statuses' clock advanced as time passed, beyond any run that began since the last status.
bool has_continued(const Run& run, const icd::RunStatus& status, const Silence& silence);

/// True if the status shows more reports left in a run that certainly goes on: somebody granted them.
bool is_grant(const Run& run, const icd::RunStatus& status, const Silence& silence);

/// A run that began up to `ago` s ago may show this clock. If a clock goes back to more, a referee set it.
bool can_be_new(double shows, double ago);

/// What the first status after another name shows of it. `before`: the earlier run, which has a status.
enum class NameCheck : std::uint8_t {
  Confirmed,     // a sign of another run agrees, or a run that began since may show this status
  Contradicted,  // the counts and the clock of `before` go on
  Unknown,
};
NameCheck check_name(const Run& before, const icd::RunStatus& status, const Silence& silence);

/// True if the clock of the statuses was seen to run, so that it would show another run.
bool can_show_other_run(const Run& run);

/// The Command Post's map after a change of run.
enum class NextMap {
  MayBeTheSame,  // the old map, or an empty one
  Empty,         // except for maps that arrived after the last status of the old run
  Earlier,       // the map of an earlier run
};

/// `now` has replaced `before`. More remaining reports are not enough, because somebody may have granted one.
NextMap next_map(const Run& before, const Run& now);

bool are_other_teams(const std::string& one, const std::string& other);

/// All runs seen. Adit keeps them, because a run continues when its Command Post returns.
class Runs {
 public:
  /// `latest`: highest run number of a report, which may have been written before its run.
  void open(std::vector<Run> all, std::int64_t latest);

  const Run& present() const { return runs_.at(present_); }
  Run& present() { return runs_.at(present_); }
  /// The run of a report that is posted now: present(), or the run of set_next_run().
  const Run& expected_run() const { return runs_.at(will_be_ != 0 ? will_be_ : present_); }
  /// Run `number` will be the present one. 0: no change is due.
  void set_next_run(std::int64_t number) { will_be_ = number; }
  const Run* find(std::int64_t number) const;
  const std::map<std::int64_t, Run>& all() const { return runs_; }

  /// Of the fitting runs the one that was present last, except the present one; or null.
  const Run* latest(const std::function<bool(const Run&)>& fits) const;
  const Run* latest_at(const std::string& post) const;
  std::int64_t next_number() const { return runs_.rbegin()->first + 1; }
  /// Gives it a number and a turn.
  void begin(Run run);
  void adopt(std::int64_t number);

  /// True if run `number` is at `post`. A run that is unknown, or has no address, counts as there.
  bool is_at(std::int64_t number, const std::string& post) const;
  bool is_here(std::int64_t number) const { return is_at(number, present().post); }
  /// The present run, the run that it may still be, the run that that one may be, and so on.
  std::vector<std::int64_t> possible_runs() const { return possible_runs(present_); }
  /// True if run `number` is `other`, or may still be.
  bool can_be(std::int64_t number, std::int64_t other) const;
  /// Run::name_trouble of the present run, or of one that it may still be. "": names count.
  const std::string& name_trouble() const;
  /// True if `number` is one of possible_runs(), but not the present run.
  bool can_be_present(std::int64_t number) const { return number != present_ && can_be(present_, number); }
  /// The present run is not `number`, which can_be_present(). Returns the run in which another run began.
  const Run& exclude(std::int64_t number);

 private:
  /// possible_runs() for run `number`.
  std::vector<std::int64_t> possible_runs(std::int64_t number) const;
  std::int64_t next_turn() const;

  std::map<std::int64_t, Run> runs_{{1, Run{}}};
  std::int64_t present_ = 1;
  std::int64_t will_be_ = 0;
};

}  // namespace adit::dispatch
