#pragma once

#include <chrono>

#include "queues/queued_map.hpp"

namespace adit::queues {

/// Decides whether the next map may be sent before the Command Post has answered the previous one, so that
/// the link is not idle meanwhile. At most two maps are in flight, and the first one has arrived.
///
/// A map goes ahead if all of this holds:
/// - The order of the two does not matter, even if the first one fails and is retried after the second one:
///   they are maps of different senders, or clouds of one sender that are parts.
/// - The Command Post has accepted the last kWell maps, and its answer is not late by kLate. Otherwise more
///   maps would not help it.
/// - The previous map has never failed.
///
/// After each failure with two maps in flight, twice as many maps have to be accepted in a row. A Command
/// Post that cannot handle two maps therefore mostly gets one at a time.
class Pipelining {
 public:
  static constexpr int kWell = 2, kMostWell = 128;
  static constexpr std::chrono::milliseconds kLate{500};

  /// The previous map, and when it had arrived.
  struct Before {
    const QueuedMap& map;
    Instant arrived;
    bool went_ahead;
  };
  bool may_go(const QueuedMap& next, const Before& before, Instant now) const;

  /// A map was accepted. `ahead`: it was sent before the previous map was answered.
  void taken(bool ahead);
  /// A map was not accepted, for any reason. `two`: two maps were in flight.
  void failed(bool two);

 private:
  int taken_ = 0;       // in a row
  int well_ = kWell;    // as many are needed
  bool tried_ = false;  // a map that went ahead is among them
};

/// Whether a Command Post may accept the two maps in either order.
bool in_any_order(const QueuedMap& one, const QueuedMap& other);

}  // namespace adit::queues
