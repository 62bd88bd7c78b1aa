#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "pace/rate_limit.hpp"

namespace adit::pace {

/// TCP payload in bytes per second that maps may use on a link of `megabit` Mbit/s (> 0): 11.5 MB/s at 100,
/// where full frames carry 11.77. The frames then stay within the link, so no report queues behind a map.
std::uint64_t map_bytes_per_second(double megabit);

/// The state of a TCP connection at one time (TCP_INFO).
struct Progress {
  Instant at{};
  std::uint64_t delivered = 0;                // bytes since the connection began
  std::size_t unsent = 0;                     // bytes that TCP holds and has not sent yet
  std::size_t in_flight = 0;                  // bytes sent and not acknowledged
  Duration round_trip{}, least_round_trip{};  // now; without a queue
};

/// Measures how fast the link delivers a connection's bytes, and sets the pace of writing, as bytes that are
/// written faster queue before the slow part of the link, and a report behind them. Rates: bytes per second.
///
/// Works like BBR (draft-ietf-ccwg-bbr) with longer intervals. The delivery rate while a queue exists is the
/// rate of the link. While a queue exists, the pace is half of that rate. From time to time a probe adds a
/// quarter until a queue forms, because the link may have become faster. An interval in which TCP had too
/// little to send does not lower the rate, however late the peer acknowledges.
class Delivery {
 public:
  static constexpr std::chrono::milliseconds kInterval{50};  // or two round trips, if they take longer
  static constexpr std::chrono::seconds kRemembered{1};
  /// Pause between two probes. It doubles after each probe that finds no faster link.
  static constexpr std::chrono::milliseconds kFirstWait{100}, kLongestWait{800};
  static constexpr double kSlowest = 0.01;  // part of `most`

  /// `most`: the highest pace, > 0.
  explicit Delivery(double most) : most_(most), link_(most) {}

  /// Call this when writing starts after a pause or on a new connection.
  void on_write_begun(const Progress& now);
  /// Call this at least once in kInterval while bytes are written.
  void on_write(const Progress& now);

  /// The pace at which to write.
  double pace() const;
  /// The highest delivery rate of an interval in this second and the previous one. If TCP had too little to
  /// send, an interval counts only if faster than the link's known rate. `most` if no rate is known.
  double delivery_rate() const;

 private:
  double measured_rate(const Progress& now) const;
  void queue_ended_probe(const Progress& now);
  void measure(double rate, Instant now);
  void remember(double rate, Instant now);
  void set_rate(double rate, Instant now);
  void end_probe(bool in_vain, Instant now);

  double most_;
  double link_;                            // its rate without a queue
  double most_now_ = 0, most_before_ = 0;  // highest rates of this second and the previous one
  Instant second_began_{};
  Progress began_{};     // the state at the start of the interval
  bool queued_ = false;  // a queue existed during the whole interval
  int stands_ = 0;       // successive intervals with a queue
  bool drains_ = false;  // a queue is being drained
  bool starved_ = false;
  bool probes_ = false;
  Instant probe_at_{};  // the earliest time of the next probe
  Duration wait_ = kFirstWait;
};

}  // namespace adit::pace
