#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "alarms/facts.hpp"

namespace adit::alarms {

/// How one connection to the Command Post stands.
struct Seen {
  bool connected = false;
  bool busy = false;            // an answer is awaited
  std::uint64_t ended = 0;      // requests that ended, in any way
  std::uint64_t throttled = 0;  // those that were answered 429
  std::uint64_t sent = 0;       // bytes that left
  int status = 0;               // of the last one; 0: none came
  bool foreign = false;         // what answered it is no Command Post
  std::string said = {};        // why the last one came to nothing, or why there is no connection; or ""
};

/// Over one endpoint, by all its connections: what is wrong with it, and since when.
class PostWatch {
 public:
  static constexpr double kUnreachableAfter = 3;  // seconds
  static constexpr double kSilentAfter =
      15;  // since the last byte that left of the first request without an answer
  static constexpr double kFailingAfter = 5;
  static constexpr double kStillWell =
      15;  // another connection's good answer stands for the endpoint so long
  static constexpr double kThrottledWithin = 30;
  static constexpr std::size_t kThrottled = 3;  // answers of 429 within that time

  /// To be told each second, of the same connections in the same order. `now`: seconds of a clock
  /// that never steps.
  void look(const std::vector<Seen>& seen, double now);
  /// It is another place, or has another token.
  void forget();
  /// What is wrong; Endpoint::name and address are the caller's.
  Endpoint endpoint(double now) const;

 private:
  struct Way {
    Seen seen = {};
    std::optional<double> well = {};     // when it answered well, last
    std::optional<double> waits = {};    // since when no answer comes
    std::optional<double> without = {};  // since when there is no connection
    std::optional<double> failing = {};  // since when it answers with errors alone
    std::optional<double> barred = {};   // since when it is refused, or somebody else answers
  };
  void look(Way& way, const Seen& seen, double now);
  bool is_well_elsewhere(const Way& way, double since, double now) const;
  Endpoint trouble_of(const Way& way, double now) const;
  Endpoint throttling(double now) const;

  std::vector<Way> ways_;
  bool is_stopped_ = false;           // it took nothing, when last looked at
  std::optional<double> well_since_;  // when that was over
  std::deque<double> throttled_;      // when, the last kThrottled
};

}  // namespace adit::alarms
