#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "alarms/habits.hpp"
#include "facts/snapshot.hpp"
#include "forward/flow.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// Counts the team's rejected or closed connections and wrong tokens, shows present ones, logs once a minute.
class Crowding {
 public:
  static constexpr std::chrono::minutes kRecent{1}, kLogEvery{1};
  static constexpr std::size_t kMostAddresses = 64;

  struct Line {
    std::string sentence;
    std::uint64_t times;  // since the last log line
  };

  void on_ended(intake::CloseReason why, const std::string& address, loop::Instant now);
  std::uint64_t count(intake::CloseReason why) const { return at(why).count; }
  /// Of the last kRecent.
  std::vector<facts::Crowd> crowds(loop::Instant now) const;
  /// Lines that are due.
  std::vector<Line> to_log(loop::Instant now);

 private:
  struct Kind {
    std::uint64_t count = 0, logged = 0;
    loop::Instant last{}, log_at{};
    std::map<std::string, std::uint64_t> by_address;  // in the present crowd
  };
  static constexpr std::array kTold{intake::CloseReason::NoRoom, intake::CloseReason::GaveWay,
                                    intake::CloseReason::WrongToken, intake::CloseReason::NoToken};

  const Kind& at(intake::CloseReason why) const { return kinds_[static_cast<std::size_t>(why)]; }
  std::string sentence(intake::CloseReason why) const;
  const std::string& most_of(intake::CloseReason why) const;

  std::array<Kind, intake::kEndedKinds> kinds_;
};

/// Facts that need observation over time: the endpoints' answers, the robots' intervals, the growth of the
/// queue. `now`: seconds of the stamp clock, which never steps.
class ObservedFacts {
 public:
  /// Call once a second. `time`: time of day.
  void update(forward::Flow& flow, const settings::Settings& settings,
              const std::vector<facts::ActivityRow>& activities, double now, facts::Time time);
  /// Call after the flow's start and before any answer: takes the robots from before.
  void restore(const forward::Flow& flow, double now);
  /// The endpoint or its token has changed.
  void forget_scoring() { scoring_.forget(); }
  void forget_mapping() { mapping_.forget(); }

  /// Scoring, then mapping. `time`: time of day.
  std::vector<facts::EndpointRow> endpoints(const forward::Flow& flow,
                                            const settings::CommandPost& command_post, double now,
                                            facts::Time time) const;
  facts::Habits habits(const settings::Alarms& rules, double now) const;
  bool is_queue_growing(double now) const { return growth_.grows(now); }

 private:
  alarms::EndpointWatch scoring_, mapping_{true};
  alarms::Habits habits_;
  alarms::Growth growth_;
  std::map<std::string, std::uint64_t> told_;  // accepted and forwarded messages at the last save
};

}  // namespace adit::gateway
