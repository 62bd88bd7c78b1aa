#pragma once

#include <cstdint>

namespace adit::journal {

/// Kinds of records. The numbers are in files and must not change.
enum class Kind : std::uint8_t {
  Clock = 1,         // a boot, a monotonic time and its stamp
  LifeBegins = 2,    // a process started; its predecessor's messages in flight count as not delivered
  Senders = 18,      // senders' clocks
  StateSent = 5,     // poses by robot
  StateDone = 6,     // delivered or rejected
  StateBack = 7,     // queued again
  MarkersSent = 10,  // markers by ns, id and action
  MarkersDone = 11,
  MarkersBack = 12,
  Pace = 13,     // the next request of a URI, and its learned spacing
  Stamp = 14,    // the last stamp of a URI
  Grids = 16,    // the extent of the posted grids of a name
  Poses = 19,    // an accepted /state/update
  Heard = 20,    // when a robot posted, and how often it posts
  Markers = 21,  // an accepted /markers/update
};

}  // namespace adit::journal
