#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "simulation/faults.hpp"
#include "simulation/http.hpp"
#include "simulation/messages.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

inline constexpr const char *kScored = "scored", *kInAStop = " in a stop",
                            *kNameless = ", which nothing names";
/// Of NewRun: one more report was granted, which Adit holds for another run; its map is the same.
inline constexpr const char* kSameMap = "the map stays";
/// Of Fault: the run is the same.
inline constexpr const char* kSetBack = "clock set back";
/// "run 3", as the history calls it.
std::string run_name(int place, std::int64_t run);

/// The runs of a Command Post, one after the other: it records whatever reaches it, and cannot tell a report
/// from the same one again.
class Scoreboard {
 public:
  /// `place`: which Command Post this is, from 0 on. All outlive this.
  Scoreboard(World& world, const Faults& faults, Random& random, int place);

  int place() const { return place_; }
  /// The answer to a status.
  std::string status();
  /// Records a report, of that request: the answer to it.
  std::string record(const Item& item, const HttpMessage& request);
  /// The answer to the report that was recorded last, if that is another one than `item`.
  std::optional<std::string> last_answer(const Item& item) const;
  /// Somebody else's.
  void record_another();
  /// Not before Adit saw its clock run, with the ledger at hand, and be further on than the new run's when
  /// that is first seen: nothing would tell the one run from the other.
  bool may_begin_run() const;
  void begin_run();
  /// By a minute, in the same run, which is held for another one that it may be. Requires may_begin_run().
  void set_clock_back();
  /// In the same run, which is held for another one for certain. Requires may_begin_run().
  void grant_report();
  /// What is recorded does not count.
  void stop(bool stopped) { stopped_ = stopped; }

 private:
  std::string name() const;
  std::string reply(const std::string& report, const char* state, int points);
  const char* score(int points);

  World& world_;
  const Faults& faults_;
  const int place_;
  const bool numbers_runs_;  // it names them by numbers, not by texts
  std::int64_t run_ = 1, grants_ = 0, remaining_ = 25, score_ = 0, id_ = 0;
  double run_began_;
  std::size_t run_begins_ = 0;  // in the history
  bool stopped_ = false;
  std::int64_t last_ = 0;  // the serial of the report that was recorded last
  std::string last_answer_;
};

}  // namespace adit::simulation
