#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "alarms/facts.hpp"

namespace adit::alarms {

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
  static constexpr double kSilentAfter =
      15;  // seconds from the last byte sent of the first unanswered request
  static constexpr double kFailingAfter = 5;
  static constexpr double kStillWell =
      15;  // seconds for which a good answer on another connection vouches for the endpoint
  static constexpr double kThrottledWithin = 30;
  static constexpr std::size_t kThrottled = 3;  // answers of 429 within kThrottledWithin

  /// `has_robots`: a 401 or 403 may concern one robot, so if messages were accepted before, it
  /// counts as trouble after kFailingAfter.
  explicit EndpointWatch(bool has_robots = false) : has_robots_(has_robots) {}

  /// Call each second with the same connections in the same order. `now`: monotonic seconds.
  void look(const std::vector<ConnectionSample>& seen, double now);
  /// Call if the endpoint's address or token has changed.
  void forget();
  /// The trouble; the caller sets Endpoint::name and address.
  Endpoint endpoint(double now) const;

 private:
  struct ConnectionState {
    ConnectionSample seen = {};
    std::optional<double> well = {};     // last good answer
    std::optional<double> waits = {};    // start of the wait for an answer
    std::optional<double> without = {};  // start of the time without a connection
    std::optional<double> failing = {};  // start of errors as the only answers
    std::optional<double> barred = {};   // start of answers 401, 403, or from another server
  };
  void look(ConnectionState& way, const ConnectionSample& seen, double now);
  bool is_well_elsewhere(const ConnectionState& way, double since, double now) const;
  Endpoint trouble_of(const ConnectionState& way, double now) const;
  Endpoint throttling(double now) const;

  bool has_robots_;
  std::vector<ConnectionState> ways_;
  bool is_stopped_ = false;           // at the last look
  std::optional<double> well_since_;  // end of the last stop
  std::deque<double> throttled_;      // times of the last kThrottled answers of 429
};

}  // namespace adit::alarms
