#pragma once

#include <optional>

#include "codec/row.hpp"

namespace adit::alarms {

/// The run's clock as all faces show it.
struct ShownClock {
  double seconds = 0;  // of the run, now
  double age = 0;      // seconds since the status that the clock comes from
  bool runs = false;   // `seconds` goes on by itself
  bool old = false;    // the status is no longer fresh: with `runs`, `seconds` is an estimate

  static const codec::Row kRow;
  friend bool operator==(const ShownClock&, const ShownClock&) = default;
};

/// The run's clock between two statuses. Times are seconds of a clock that never steps.
class RunClock {
 public:
  /// Call for each status; `shows`: its clock.
  void heard(double shows, double now);
  /// The clock at `now`, after the first status. A clock goes on unless it is at 0 s, or two statuses that
  /// are more than 1.5 s apart show the same.
  std::optional<ShownClock> at(double now) const;

 private:
  struct Heard {
    double shows = 0, at = 0;
    bool runs = false;
  };
  std::optional<Heard> heard_;
};

}  // namespace adit::alarms
