#pragma once

#include <cstdint>
#include <deque>
#include <expected>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "alarms/alarm.hpp"
#include "codec/row.hpp"

namespace adit::alarms {

/// An acknowledgement of an alarm as it then was. It outlives a restart of the service.
struct Acknowledgement {
  static constexpr std::size_t kMost = 64;       // stored acknowledgements
  static constexpr std::size_t kLongest = 1024;  // bytes of what and why; longer ones are not stored
  static constexpr double kHolds = 3600;         // seconds of validity across a restart
  static constexpr double kWaitsFor = 60;        // seconds after a start within which the alarm must return

  std::string id = {};
  Severity severity = Severity::Wait;
  std::uint64_t degree = 0;
  std::string what = {}, why = {};
  double at = 0;  // seconds since 1970

  static const codec::Row kRow;
  friend bool operator==(const Acknowledgement&, const Acknowledgement&) = default;
};

/// The file: {"version": 1, "acknowledged": [...]}.
std::string write_acknowledged(const std::vector<Acknowledgement>& all);
/// An error anywhere rejects the whole file.
std::expected<std::vector<Acknowledgement>, std::string> read_acknowledged(std::string_view json);

/// History of the conditions: start of each, acknowledgements, and the last kMostOver that ended.
class Board {
 public:
  static constexpr std::size_t kMostOver = 8;

  /// Records new and ended conditions. `now`: as in Facts. Call each second, and before acknowledge().
  void update(const std::vector<Condition>& conditions, double now);
  /// Call if the time of day was advanced by `seconds`: shifts all times, so that durations stay the same.
  void move(double seconds);
  /// Silences the alarm until it gets worse or ends. If its degree falls, a later rise from there counts as
  /// worse. Error: there is no alarm with that id.
  std::expected<void, std::string> acknowledge(const std::string& id, double now);

  /// Restores acknowledgements from before a restart at `now`. Each takes effect if its alarm returns
  /// unchanged within Acknowledgement::kWaitsFor. An alarm that got worse, ended or changed its text is new.
  void remember(std::vector<Acknowledgement> before, double now);
  /// Acknowledgements to store for the next start.
  std::vector<Acknowledgement> acknowledgements() const;

  /// The conditions as alarms: by severity, then the oldest first.
  std::vector<Alarm> to_alarms(const std::vector<Condition>& conditions, double now) const;
  /// Newest first.
  std::vector<EndedAlarm> ended_alarms() const { return {over_.begin(), over_.end()}; }

 private:
  struct KnownCondition {
    Condition condition, worst;  // now; at its worst, for the history
    double since = 0, worst_since = 0;
    bool acknowledged = false;
    Acknowledgement seen = {};  // the alarm when it was acknowledged
  };
  static bool is_worse(const Condition& condition, const KnownCondition& known);
  static void acknowledge_as_shown(KnownCondition& known, double now);
  void restore_acknowledged(const std::vector<Condition>& conditions, double now);
  static EndedAlarm to_ended(const KnownCondition& known, double now);

  std::map<std::string, KnownCondition> known_;
  std::deque<EndedAlarm> over_;
  std::vector<Acknowledgement> before_;  // alarms that have not returned yet
  double waits_until_ = 0;
};

/// Whether the alarm calls the operator: the attention light blinks, and `adit status` exits with 1.
inline bool calls(const Alarm& alarm) {
  return alarm.severity != Severity::Wait;
}

}  // namespace adit::alarms
