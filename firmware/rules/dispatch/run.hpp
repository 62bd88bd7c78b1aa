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

  bool was_heard() const { return last.has_value() || !id.empty(); }
  std::int64_t place() const { return turn > number ? turn : number; }
  friend bool operator==(const Run&, const Run&) = default;
};

}  // namespace adit::dispatch
