#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "icd/run_status.hpp"

namespace adit::dispatch {

/// A run's clock at one URI. The URIs may have different clocks, and clocks may stand.
struct Clock {
  double shows = 0;   // seconds of the run, as last heard
  bool runs = false;  // seen to advance; only then is it evidence

  friend bool operator==(const Clock&, const Clock&) = default;
};

inline Clock seen_again(const std::optional<Clock>& seen, double shows) {
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
  Signs& operator|=(const Signs& more) {
    count |= more.count, clock |= more.clock, score |= more.score, name |= more.name;
    return *this;
  }
  friend bool operator==(const Signs&, const Signs&) = default;
};

/// A run of the Command Post. Its address, team and name identify it. If these are equal, a status may show a
/// difference (run_watch.hpp).
struct Run {
  /// In `unreliable`: no sign of another sender.
  static constexpr const char* kCountsStand =
      "the Command Post's counts have not changed since the first report, so that they prove no report";

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

}  // namespace adit::dispatch
