#pragma once

#include <chrono>

#include "lanes/waiting_map.hpp"

namespace adit::lanes {

/// Whether the next map may go ahead: be sent before the Command Post has answered the one before, so that
/// the link is not idle until then. At most two are under way, and the first has arrived.
///
/// Only where it is of no consequence which of the two is taken first, or that the first one fails and is
/// sent again after the second one: maps of different senders, and clouds of one that are parts. Only at a
/// Command Post that has taken the last kWell maps, of one that was never failed at, and that is not late
/// with its answer: else it is no help to give it more. After each failure while two were under way it takes
/// twice as many, so that one to which two are too much has one at a time, as a rule.
class Ahead {
 public:
  static constexpr int kWell = 2, kMostWell = 128;
  static constexpr std::chrono::milliseconds kLate{500};

  /// The map before, which arrived at `arrived`.
  struct Before {
    const WaitingMap& map;
    Instant arrived;
    bool went_ahead;
  };
  bool may_go(const WaitingMap& next, const Before& before, Instant now) const;

  /// One was taken. `ahead`: it had gone ahead.
  void taken(bool ahead);
  /// One was not, whatever happened. `two`: while two were under way.
  void failed(bool two);

 private:
  int taken_ = 0;       // in a row
  int well_ = kWell;    // so many are enough
  bool tried_ = false;  // one that went ahead is among them
};

/// Whether it is of no consequence which of the two a Command Post takes first.
bool in_any_order(const WaitingMap& one, const WaitingMap& other);

}  // namespace adit::lanes
