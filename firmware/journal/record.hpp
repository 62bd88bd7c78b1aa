#pragma once

#include <cstdint>

namespace adit::journal {

/// What a record tells. The numbers are in files: they stay.
enum class Kind : std::uint8_t {
  Clock = 1,         // the start of the machine, an instant and the stamp of that instant
  LifeBegins = 2,    // what was under way in the life before came to nothing, as far as anybody knows
  Sender = 18,       // a sender's clock
  StateSent = 5,     // these robots' poses are under way
  StateDone = 6,     // what was under way needs no more care
  StateBack = 7,     // it waits again
  MarkersSent = 10,  // these are under way, and wait no more
  MarkersDone = 11,
  MarkersBack = 12,
  Pace = 13,     // when a URI may be asked next, and what spacing was learned
  Stamp = 14,    // the last stamp of a URI
  Grids = 16,    // where grids of a name were posted
  Poses = 19,    // of a /state/update that was accepted
  Heard = 20,    // when a robot was heard, and how often it posts
  Markers = 21,  // of a /markers/update that was accepted
};

}  // namespace adit::journal
