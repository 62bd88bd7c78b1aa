#pragma once

#include <optional>

#include "codec/row.hpp"
#include "facts/rows.hpp"

namespace adit::alarms {

/// Time limits of all faces, in seconds.
inline constexpr double kLateAfter = 10;       // in addition to one turn of all senders
inline constexpr double kFailingAfter = 10;    // failing then becomes "not arriving"
inline constexpr double kStuckAfter = 90;      // late becomes "not arriving", or after 3 times the late limit
inline constexpr double kQuietAfter = 60;      // since the last message was accepted, if all are delivered
inline constexpr double kStatusOldAfter = 15;  // age at which a status of the run is old

/// `turn`: seconds in which each queued map has its turn. `silent`: of the row's robot.
facts::Arrival arrival_of(const facts::ActivityRow& row, double turn, bool silent);
facts::Level level_of(facts::Arrival arrival);

/// The run's clock as all faces show it.
struct ShownClock {
  double seconds = 0;  // run time now
  double age = 0;      // seconds since the status was received
  bool runs = false;   // `seconds` advances
  bool old = false;    // the status is old; if `runs`, `seconds` is an estimate

  static const codec::Row kRow;
  friend bool operator==(const ShownClock&, const ShownClock&) = default;
};

/// The run's clock between two statuses. All times are monotonic seconds.
class RunClock {
 public:
  /// Call for each status. `shows`: its clock.
  void on_status(double shows, double now);
  /// The clock at `now`, or std::nullopt before the first status. A clock advances unless it is at 0 s, or
  /// two statuses more than 1.5 s apart show the same time.
  std::optional<ShownClock> at(double now) const;

 private:
  struct Heard {
    double shows = 0, at = 0;
    bool runs = false;
  };
  std::optional<Heard> heard_;
};

}  // namespace adit::alarms
