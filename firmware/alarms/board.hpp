#pragma once

#include <cstdint>
#include <deque>
#include <expected>
#include <map>
#include <string>
#include <vector>

#include "alarms/acknowledged.hpp"
#include "alarms/alarm.hpp"

namespace adit::alarms {

/// What is known of the conditions over time: since when each lasts, who has seen it, which ones went. Holds
/// as many as conditions_of() gives, and kMostOver that went.
class Board {
 public:
  static constexpr std::size_t kMostOver = 8;

  /// Takes note of what came and went; `now` as in Facts. To be called each second, and before
  /// acknowledge().
  void take(const std::vector<Condition>& conditions, double now);
  /// The time of day was set ahead by so many seconds: each lasts as long as it did.
  void move(double seconds);
  /// Quiets the alarm until it gets worse or comes again. If its degree falls meanwhile, a rise from there is
  /// worse. Error: there is no alarm of that id.
  std::expected<void, std::string> acknowledge(const std::string& id, double now);

  /// What was acknowledged before this start, at `now`. Each holds once its alarm is back as it was, in every
  /// word, within Acknowledged::kWaitsFor: what got worse, went, or reads otherwise is as loud as a new one.
  void remember(std::vector<Acknowledged> before, double now);
  /// What is to be remembered after the next start.
  std::vector<Acknowledged> acknowledged() const;

  /// These, as they are to be shown: bad before ask before wait, then oldest first.
  std::vector<Alarm> shown(const std::vector<Condition>& conditions, double now) const;
  /// The newest first.
  std::vector<Over> over() const { return {over_.begin(), over_.end()}; }

 private:
  struct Known {
    Condition condition;
    double since = 0;
    bool acknowledged = false;
    Acknowledged seen = {};  // as it was then
  };
  static bool is_worse(const Condition& condition, const Known& known);
  static void see(Known& known, double now);
  void take_up_before(const std::vector<Condition>& conditions, double now);
  static Over over(const Known& known, double now);

  std::map<std::string, Known> known_;
  std::deque<Over> over_;
  std::vector<Acknowledged> before_;  // whose alarms are not back yet
  double waits_until_ = 0;
};

/// Whether it calls the operator: the attention light blinks, `adit status` ends with 1.
inline bool calls(const Alarm& alarm) {
  return alarm.severity != Severity::Wait;
}

}  // namespace adit::alarms
