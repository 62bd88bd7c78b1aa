#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/random.hpp"

namespace adit::simulation {

/// Faults of the Command Post and of the network to it.
enum class Fault : std::uint8_t {
  LostBefore,      // the connection is reset; nothing is recorded
  LostAfter,       // recorded, perhaps seconds later, and the connection is reset
  CutAnswer,       // recorded, and the answer ends at any byte
  Delay,           // recorded and answered, up to 8 s late
  Silence,         // no answer; recorded or not
  Storm,           // 429 to all for some seconds
  PoliteStorm,     // 429 with Retry-After
  Error,           // 500, recorded or not
  Html,            // a 200 of another server
  HugeLength,      // an answer with a length of 10^12 bytes; recorded or not
  HugeChunk,       // recorded; the answer's first chunk announces 3 * 10^10 bytes
  WrongLength,     // recorded; the answer's body is longer or shorter than its length
  Garbage,         // recorded; the answer is not HTTP
  WrongTypes,      // recorded; the answer is unrelated JSON
  Redirect,        // a redirect; not recorded
  Between,         // 502, 503 or 504 of a proxy; recorded or not
  Unwanted,        // 422 to a valid map or state
  TakenThrottled,  // 429 to a message that is accepted
  OddAnswer,       // correct, but chunked or after an interim answer
  ClosesAfter,     // correct, then the connection is closed or reset
  Refused,         // connections are refused for some seconds
  Deaf,            // connection attempts get no answer for some seconds
  Mute,            // no answer to anything for some seconds
  Outage,          // all connections are reset and refused for up to 25 s
  StatusDown,      // only the status gets no answer
  ConstantClocks,  // clocks that stand still, as the public test server's
  NamelessRuns,    // answers to reports do not name the run
  NewRun,
  OtherSender,  // another sender reports with the same token
  AdminStop,    // the run is stopped; records do not count for some seconds
  End
};
std::string name_of(Fault fault);

/// The faults of a run and their rates. Half of the runs have at most two kinds.
class Faults {
 public:
  explicit Faults(Random random);
  bool has(Fault fault) const { return odds_[static_cast<std::size_t>(fault)] > 0; }
  /// Draws the fault of one request; End: none.
  Fault of_request();
  /// "Silence Storm", or "none".
  std::string names() const;

 private:
  Random random_;
  std::vector<double> odds_;
};

}  // namespace adit::simulation
