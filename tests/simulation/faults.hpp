#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/random.hpp"

namespace adit::simulation {

/// What may go wrong at the Command Post, and in the network to it.
enum class Fault : std::uint8_t {
  LostBefore,      // the connection is reset; nothing is recorded
  LostAfter,       // recorded, perhaps seconds later, and the connection is reset
  CutAnswer,       // recorded, and the answer ends at any byte
  Delay,           // recorded and answered, up to 8 s late
  Silence,         // no answer; recorded or not
  Storm,           // 429 to all for some seconds
  PoliteStorm,     // with Retry-After
  Error,           // 500, recorded or not
  Html,            // a 200 of somebody else
  HugeLength,      // an answer that says it has 10^12 bytes; recorded or not
  HugeChunk,       // recorded; the answer's first chunk is to have 3 * 10^10 bytes
  WrongLength,     // recorded; the answer has more bytes than it says, or fewer
  Garbage,         // recorded; what comes is no HTTP
  WrongTypes,      // recorded; JSON that says nothing of what was asked
  Redirect,        // look elsewhere; not recorded
  Between,         // 502, 503 or 504 of something in between; recorded or not
  Unwanted,        // 422 to a map or state, for nothing
  TakenThrottled,  // 429 to one that is taken all the same
  OddAnswer,       // right, in chunks or behind an interim answer
  ClosesAfter,     // right, and the connection is closed or reset behind it
  Refused,         // nobody listens for some seconds
  Deaf,            // connecting is not answered for some seconds
  Mute,            // nor is anything else
  Outage,          // all connections are reset, and nobody listens for up to 25 s
  StatusDown,      // the status alone is not answered
  ConstantClocks,  // as the public test server's
  NamelessRuns,    // answers to reports do not name the run
  NewRun,
  OtherSender,  // somebody else reports with the same token
  AdminStop,    // records do not count for some seconds
  End
};
std::string name_of(Fault fault);

/// Which of them exist in a run, and how often they come: half of the runs have at most two kinds.
class Faults {
 public:
  explicit Faults(Random random);
  bool has(Fault fault) const { return odds_[static_cast<std::size_t>(fault)] > 0; }
  /// The fault of one request; End: none.
  Fault of_request();
  /// "Silence Storm", or "none".
  std::string names() const;

 private:
  Random random_;
  std::vector<double> odds_;
};

}  // namespace adit::simulation
