#pragma once

#include <cstdint>
#include <optional>

#include "rehearsal/command_post/http.hpp"

namespace adit::rehearsal {

/// Between which moments of one request and the next a rate limit measures.
enum class Counted : std::uint8_t {
  Starts,     // from header to header
  LastBytes,  // from last byte to last byte
  Answers,    // from when the one was judged, to be answered, to the header of the next
  Decoded,    // from when the one was decoded to when the next was: the measured mapping server
};

/// "Approximately" `hz` requests a second (ICD 4.1): one that comes sooner than 95 % of the interval after
/// the last one counted is too many, as measured 100 %. 0 Hz: no limit. Not safe for several threads.
class RateLimit {
 public:
  explicit RateLimit(double hz, Counted counted = Counted::Starts) : hz_(hz), counted_(counted) {}

  /// `now`: when it was decoded.
  bool too_soon(const Request& request, Clock::time_point now) const;
  /// `now`: when it was judged; may be said again, and then the later one holds.
  void count(const Request& request, Clock::time_point now);

 private:
  double hz_;
  Counted counted_;
  std::optional<Clock::time_point> last_;
};

}  // namespace adit::rehearsal
