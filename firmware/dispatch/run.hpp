#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "icd/run_status.hpp"

namespace adit::dispatch {

/// What was seen of a run's clock by one URI: each of the Command Post's URIs may have a clock of its own,
/// and one that stands.
struct Clock {
  double shows = 0;   // seconds of the run, as last heard
  bool runs = false;  // it was seen to go on: only then does it prove anything

  friend bool operator==(const Clock&, const Clock&) = default;
};

/// `seen` after the clock shows `shows`.
inline Clock seen_again(const std::optional<Clock>& seen, double shows) {
  if (!seen) return {.shows = shows};
  return {.shows = shows, .runs = seen->runs || shows > seen->shows};
}

/// One run of the Command Post, as far as it is known. Three things tell runs apart: where the Command Post
/// is, the team, and the name that its answers give the run; where those are the same, its status does
/// (run_watch.hpp).
struct Run {
  /// Of `unreliable`: its counts were the same after Adit's reports as before the first of them. That says
  /// nothing of another sender.
  static constexpr const char* kCountsStand =
      "the Command Post's counts have not changed since the first report, so that they prove no report";

  std::int64_t number = 1;                            // Adit's own, from 1
  std::string id = "";                                // the Command Post's (ICD 5.2 `run`); "": not heard yet
  double began = 0;                                   // when it was noticed; seconds since 1970
  std::string why = "";                               // how it was noticed: a sentence
  std::optional<icd::RunStatus> last = std::nullopt;  // the last status heard in it
  double heard = 0;                                   // when; seconds since 1970
  std::string post = "";        // where the Command Post was: address and port; "": not known
  std::string unreliable = "";  // why its count of reports proves nothing (another sender...); "": it does

  std::int64_t turn = 0;    // the later it became the present one, the higher; 0: as its number
  std::int64_t may_be = 0;  // the run before it, where it may be that one still; 0: it is another for certain
  std::optional<Clock> status_clock = std::nullopt;  // of GET /api/status
  std::optional<Clock> answer_clock = std::nullopt;  // of the answers to reports

  /// The Command Post has said something in it.
  bool was_heard() const { return last.has_value() || !id.empty(); }
  std::int64_t place() const { return turn > number ? turn : number; }
  friend bool operator==(const Run&, const Run&) = default;
};

}  // namespace adit::dispatch
