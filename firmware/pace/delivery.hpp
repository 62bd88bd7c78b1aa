#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "pace/rate_limit.hpp"

namespace adit::pace {

/// How a connection sends, as its TCP says at one moment (TCP_INFO).
struct Progress {
  Instant at{};
  std::uint64_t delivered = 0;                // bytes, since the connection began
  std::size_t unsent = 0;                     // bytes that TCP still has to send
  std::size_t in_flight = 0;                  // bytes that it has sent and the peer has not acknowledged
  Duration round_trip{}, least_round_trip{};  // now, and without a queue
};

/// What a link delivers of what one connection gives it, and how fast to give: no faster than that, for what
/// is given too fast waits in a queue before the slow part of the link, and a report would wait behind it.
///
/// Like BBR (draft-ietf-ccwg-bbr), with longer intervals. What was delivered while a queue stood is what the
/// link carries. While one stands, half is given. Now and then a quarter more is given, until a queue stands,
/// so that a link that is faster again is found out. An interval in which TCP was given too little to send
/// says nothing of the link, however late the peer acknowledges. All rates in bytes a second.
class Delivery {
 public:
  static constexpr std::chrono::milliseconds kInterval{50};  // or two round trips, where that is longer
  static constexpr std::chrono::seconds kRemembered{1};
  /// From one quarter more to the next, doubling while it is in vain.
  static constexpr std::chrono::milliseconds kFirstWait{100}, kLongestWait{800};
  static constexpr double kSlowest = 0.01;  // of `most`

  /// `most` > 0: so fast at the most.
  explicit Delivery(double most) : most_(most), link_(most) {}

  /// Bytes are given from now on, after a while of none, or on a new connection.
  void begins(const Progress& now);
  /// To be told while bytes are given, at least once in kInterval.
  void goes_on(const Progress& now);

  /// How fast to give.
  double pace() const;
  /// The most that was delivered in any interval of this second and the one before, of those in which bytes
  /// were given all the time; `most` where nothing is known.
  double delivers() const;

 private:
  double rate_until(const Progress& now) const;
  void queue_ended_probe(const Progress& now);
  void judge(double rate, Instant now);
  void remember(double rate, Instant now);
  void carries(double rate, Instant now);
  void end_probe(bool in_vain, Instant now);

  double most_;
  double link_;                            // carries that without a queue
  double most_now_ = 0, most_before_ = 0;  // delivered in a second
  Instant second_began_{};
  Progress began_{};     // the interval
  bool queued_ = false;  // all through it
  int stands_ = 0;       // a queue, for so many intervals
  bool drains_ = false;  // the queue
  bool starved_ = false;
  bool probes_ = false;
  Instant probe_at_{};  // not before
  Duration wait_ = kFirstWait;
};

}  // namespace adit::pace
