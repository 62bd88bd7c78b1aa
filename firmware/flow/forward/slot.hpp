#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "loop/loop.hpp"
#include "pack/pack.hpp"
#include "queues/clouds.hpp"
#include "uplink/exchange.hpp"

namespace adit::forward {

/// How large the next map may be, by the last ones: how fast the link takes bytes, and how small clouds pack.
class Slot {
 public:
  static constexpr std::chrono::milliseconds kLongestLead{1500};

  /// `most`: bytes a second that maps may use of the link.
  explicit Slot(std::uint64_t most) { allow(most); }
  void allow(std::uint64_t most);

  void on_packing_done(loop::Duration took);
  /// Effort::Full packs so many bytes of a cloud's points to so many, at that precision.
  void on_packed(std::size_t points, std::size_t bytes, queues::Precision precision);
  /// A worker packed a map in `took`; pack::seconds_for() expects `expected` seconds; 0: not compressed.
  void on_work_done(loop::Duration took, double expected);
  void on_sent(std::size_t bytes, const uplink::SendTimes& sent, loop::Instant last_byte_not_before);

  /// The link takes no more than so many bytes a second now; 0: not known.
  void set_link_rate(std::uint64_t bytes_per_second);

  /// The endpoint accepted a message of so many bytes, or answered that it is too large.
  void on_passed(std::size_t bytes);
  void on_too_large(std::size_t bytes);
  /// Another endpoint may accept other sizes.
  void forget_sizes() { largest_ = 0, limit_ = kNoLimit; }
  /// After so many accepted messages within the limit, a larger one is tried.
  static constexpr int kTryLarger = 60;
  /// The bytes of a message that the endpoint accepts, as far as its answers show. A part may have a little
  /// more than its share (fits()).
  std::size_t limit() const { return smaller_ < kTryLarger ? limit_ : kNoLimit; }

  bool fits(std::size_t bytes) const { return bytes - bytes / 32 <= limit(); }

  /// How long before its time the next map is to be packed: as the longest of the last few took, for where
  /// one comes too late, the link is idle; at most kLongestLead, for until then newer data takes its place.
  loop::Duration lead() const { return std::min<loop::Duration>(packing_takes_, kLongestLead); }
  /// How long so many bytes take to leave.
  loop::Duration transfer(std::size_t bytes) const;
  /// The conditions that decide the effort for a map, if maps are `spacing` apart. Until a map has shown how
  /// fast the link is, it is as fast as allow() says.
  pack::EffortInput effort_input(loop::Duration spacing) const;
  /// How many bytes of points, not packed, leave within `spacing` and within limit(), at each precision: by
  /// the last cloud, and by what rounding makes of clouds.
  queues::PointsAt points_for(loop::Duration spacing) const;

 private:
  loop::Duration packing_takes_{0};
  double most_ = 1, bytes_per_second_ = 1;
  double packed_to_ = 1;  // of a byte of a cloud that is exact
  double slowness_ = 1;   // pack::EffortInput's
  static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
  std::size_t largest_ = 0;  // that the endpoint accepted
  std::size_t limit_ = kNoLimit;
  int smaller_ = 0;  // messages accepted since the last one that was too large
};

}  // namespace adit::forward
