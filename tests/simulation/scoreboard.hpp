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
/// Event::what of NewRun: one more report was granted. The run goes on, and its map stays.
inline constexpr const char* kSameMap = "the map stays";
/// Event::who of a fault: an answer gives the run another name than the answer before.
inline constexpr const char* kRenames = "Renames";
/// Event::what of a fault: the clock was set back within the run.
inline constexpr const char* kSetBack = "clock set back";
/// "run 3", as in the history.
std::string run_name(int place, std::int64_t run);

/// The runs of a Command Post, one after the other. It records every report, including repetitions. In one of
/// five runs its clock is set back by a minute, or one more report is granted, up to three times. In three of
/// twenty worlds all runs are named "1", and in one of ten each answer gives the run another name.
class Scoreboard {
 public:
  /// `place`: index of the Command Post, from 0. All arguments must outlive it.
  Scoreboard(World& world, const Faults& faults, Random& random, int place);

  int place() const { return place_; }
  std::string status();
  /// Records the report of that request and returns the answer.
  std::string record(const Item& item, const HttpMessage& request);
  /// The answer to the last recorded report; nullopt if that was `item`.
  std::optional<std::string> last_answer(const Item& item) const;
  void record_another();
  /// Whether Adit can tell a new run from the current one. Adit must have seen the current run's clock run,
  /// with a working ledger, to a higher value than the new run's clock has when it is first seen.
  bool may_begin_run() const;
  void begin_run();
  /// Sets the clock back by a minute within the run, so that Adit may take it for another run. Requires
  /// may_begin_run().
  void set_clock_back();
  /// Grants a report within the run. Requires may_begin_run().
  void grant_report();
  /// While stopped, recorded reports do not count.
  void stop(bool stopped) { stopped_ = stopped; }

 private:
  /// How answers name runs. Servers exist that give all runs one name, or each answer another one.
  enum class Names : std::uint8_t { Own, One, Renamed };
  std::string name() const { return run_name(place_, run_); }
  std::string told_name();
  std::string reply(const std::string& report, const char* state, int points);
  const char* score(int points);

  World& world_;
  const Faults& faults_;
  const int place_;
  const bool numbers_runs_;  // answers name runs by number, not by text
  Names names_;
  std::int64_t run_ = 1, remaining_ = 25, score_ = 0, id_ = 0;
  double run_began_;
  std::size_t run_begins_ = 0;  // index in the history
  bool stopped_ = false;
  std::int64_t last_ = 0;  // serial of the last recorded report
  std::string last_answer_;
};

}  // namespace adit::simulation
