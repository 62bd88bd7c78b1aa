#pragma once

#include <optional>

#include "rehearsal/command_post/http.hpp"

namespace adit::rehearsal {

/// "Approximately" `hz` requests a second (ICD 4.1): one that comes sooner than 95 % of the interval after
/// the last one counted is too many. 0 Hz: no limit. Not safe for several threads.
class RateLimit {
 public:
  explicit RateLimit(double hz) : hz_(hz) {}

  /// Whether a request at `at` comes too soon.
  bool too_soon(Clock::time_point at) const;
  void count(Clock::time_point at) { last_ = at; }

 private:
  double hz_;
  std::optional<Clock::time_point> last_;
};

}  // namespace adit::rehearsal
