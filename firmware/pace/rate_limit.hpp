#pragma once

#include <chrono>
#include <optional>

namespace adit::pace {

using Instant = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

/// How often one URI may be asked: at most `hertz` times a second, evenly spaced, measured from the end of
/// one request to the start of the next where that is later. Learned down by half on a 429 (RFC 6585 4), and
/// back up by a tenth with each request that is taken.
class RateLimit {
 public:
  static constexpr double kSlowest = 1.0 / 30;  // hertz
  static constexpr std::chrono::seconds kLongestPause{30};

  /// hertz > 0.
  explicit RateLimit(double hertz) : allowed_(hertz), learned_(hertz) {}

  /// The earliest time for the next request.
  Instant next() const { return next_; }
  bool ready(Instant now) const { return now >= next_; }

  void sent(Instant now);
  /// The request sent last was answered: spacing counts from the later of the two for a server that measures
  /// at its own end.
  void taken(Instant now);
  /// 429; `retry_after` as the server gave it, heeded up to kLongestPause: more is no use in a run of half an
  /// hour.
  void throttled(Instant now, std::optional<std::chrono::seconds> retry_after);

  double hertz() const { return learned_; }

 private:
  double allowed_;
  double learned_;
  Instant next_;
};

}  // namespace adit::pace
