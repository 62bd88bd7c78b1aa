#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "facts/snapshot.hpp"

namespace adit::alarms {

/// Detects a queue that has grown for a while. One large map does not count as growth.
class Growth {
 public:
  static constexpr double kStep = 10;       // seconds
  static constexpr std::size_t kSteps = 4;  // consecutive ones
  static constexpr double kTelling = 0.05;  // share of the room below which growth is ignored
  static constexpr double kTold = 30;       // seconds that growth is reported after the last rise

  /// Call each second. `now`: monotonic seconds.
  void update(std::size_t bytes, std::size_t room, double now);
  bool grows(double now) const { return grew_ && now - last_ < kTold; }

 private:
  std::deque<std::size_t> least_;  // minimum of each step, the newest last
  double step_at_ = 0, last_ = 0;
  bool begun_ = false, grew_ = false;
};

/// The habit of a robot; outlives a restart of the service.
struct Habit {
  int messages = 0;  // received; kMessages of them make a habit
  double gap = 0;    // usual seconds between two messages
  double last = 0;   // time of the last message
};

/// Usual interval between each robot's messages, and so the silence that matters. A new run changes no habit.
class Habits {
 public:
  struct Rules {
    double least = 30;   // seconds of silence that are normal for any robot
    double times = 5;    // multiple of the robot's usual gap
    double away = 1800;  // seconds after which the robot is switched off
  };
  static constexpr int kMessages = 4;  // messages that make a habit
  static constexpr std::size_t kMost = 64;

  /// `count`: the robot's messages of all kinds so far. `now`: monotonic seconds. Call each second; messages
  /// between two calls count as one.
  void on_count(const std::string& robot, std::uint64_t count, double now);
  /// Restores an earlier process's habit. `count`: messages counted by this one before its first on_count().
  void restore(const std::string& robot, const Habit& habit, std::uint64_t count);
  /// Makes the robot's silence count from now on. For a robot that sent in this run before a reboot, and has
  /// at most one message since, which may be older than the reboot.
  void expect(const std::string& robot, double now);
  std::optional<Habit> habit_of(const std::string& robot) const;

  /// The robots that have a habit and are not switched off.
  facts::Habits robots(const Rules& rules, double now) const;

 private:
  struct KnownRobot {
    std::uint64_t count = 0;
    Habit habit = {};
    bool is_expected = false;   // no message has come since expect()
    bool was_expected = false;  // a later expect() has no effect
  };
  bool has_room(double now);

  std::map<std::string, KnownRobot> known_;
};

/// State of one connection to the Command Post.
struct ConnectionSample {
  bool connected = false;
  bool busy = false;            // waiting for an answer
  std::uint64_t ended = 0;      // requests that ended, with any result
  std::uint64_t throttled = 0;  // of these, answered 429
  std::uint64_t sent = 0;       // bytes sent
  int status = 0;               // of the last answer; 0: no answer
  bool foreign = false;         // the answer was not from a Command Post
  std::string said = {};        // why the last request or the connection failed, or ""
};

/// Finds the trouble of one endpoint from all its connections, and its start.
class EndpointWatch {
 public:
  static constexpr double kUnreachableAfter = 3;  // seconds
  /// Seconds from the last byte sent of the first unanswered request.
  static constexpr double kSilentAfter = 15;
  static constexpr double kFailingAfter = 5;
  /// Seconds for which a good answer on another connection vouches for the endpoint.
  static constexpr double kStillWell = 15;
  static constexpr double kThrottledWithin = 30;
  static constexpr std::size_t kThrottled = 3;  // answers of 429 within kThrottledWithin

  /// `has_robots`: a 401 or 403 may concern one robot, so if messages were accepted before, it counts as
  /// trouble after kFailingAfter.
  explicit EndpointWatch(bool has_robots = false) : has_robots_(has_robots) {}

  /// Call each second with the same connections in the same order. `now`: monotonic seconds.
  void update(const std::vector<ConnectionSample>& seen, double now);
  /// Call if the endpoint's address or token has changed.
  void forget();
  /// The fault, as the members `fault`, `since`, `said`, `well_for` and `waits`, in monotonic seconds.
  facts::EndpointRow endpoint(double now) const;

 private:
  struct ConnectionState {
    ConnectionSample seen = {};
    std::optional<double> well = {};     // last good answer
    std::optional<double> waits = {};    // start of the wait for an answer
    std::optional<double> without = {};  // start of the time without a connection
    std::optional<double> failing = {};  // start of errors as the only answers
    std::optional<double> barred = {};   // start of answers 401, 403, or from another server
  };
  void update(ConnectionState& way, const ConnectionSample& seen, double now);
  bool is_well_elsewhere(const ConnectionState& way, double since, double now) const;
  facts::EndpointRow endpoint_row(const ConnectionState& way, double now) const;
  facts::EndpointRow throttling(double now) const;

  bool has_robots_;
  std::vector<ConnectionState> ways_;
  bool is_stopped_ = true;  // at the last look; at a start, restored messages count as late, not as failed
  std::optional<double> well_since_;  // end of the last stop
  std::deque<double> throttled_;      // times of the last kThrottled answers of 429
};

}  // namespace adit::alarms
