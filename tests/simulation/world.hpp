#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <queue>
#include <string_view>
#include <vector>

#include "host/systemd.hpp"
#include "loop/loop.hpp"
#include "simulation/descriptors.hpp"
#include "simulation/disk.hpp"
#include "simulation/door.hpp"
#include "simulation/history.hpp"
#include "simulation/messages.hpp"
#include "simulation/network.hpp"
#include "simulation/omissions.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

using loop::Duration;
using loop::Instant;

/// Thrown out of Loop::run() if the process was killed.
struct Killed {};
/// Thrown if the process starts again by exec.
struct StartsAgain {};

inline Duration seconds(double seconds) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

/// One run: simulated time, planned events, and everything behind the seam. All of it follows from the
/// seed. There is one world at a time, current().
class World {
 public:
  static constexpr double kEpoch = 1.7e9;  // the box's clock when a run begins

  explicit World(std::uint64_t seed, Omissions without = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  static World& current();

  Random random(std::string_view name) const { return {seed_, name}; }
  /// The first robot posts maps of up to some hundred kB, and a proxy has a limit for all maps.
  bool has_large_maps() const { return has_large_maps_; }
  bool has_large_grids() const { return has_large_grids_; }
  Instant now() const { return now_; }
  double time() const;  // seconds since the run began
  double stamp() const { return kEpoch + time() + clock_ahead_; }
  double clock_ahead() const { return clock_ahead_; }
  /// Sets the box's clock, as a person does or as a boot does: in three of ten runs up to three times, by
  /// seconds or by months.
  void set_clock(double seconds_ahead);

  void at(Instant when, std::function<void()> happen);
  void after(Duration delay, std::function<void()> happen) { at(now_ + delay, std::move(happen)); }
  /// Jumps to the next event and runs it. Returns false if there is none.
  bool step();
  /// Passes time while no process runs.
  void run_for(Duration duration);
  /// The process waits for its disk while everything else goes on. A worker's job only takes longer.
  void stand_still(Duration duration);
  /// Runs an event of the process, after the process stands still no more.
  void when_moving(std::function<void()> happen);
  /// Runs `work` as a worker. Returns how long it waited for the disk.
  Duration in_worker(const std::function<void()>& work);
  std::uint64_t steps() const { return steps_; }
  /// Counts the box's draws of randomness.
  std::uint64_t entropy() { return ++entropy_; }
  /// The loop learns that a worker has ended a job. That is no event, but it may change the page.
  void job_ended() { ++jobs_ended_; }
  std::uint64_t jobs_ended() const { return jobs_ended_; }

  /// Whether this action of the actor is left out. Call before each action that an actor may leave out.
  bool omits(const std::string& actor);
  const Actions& actions() const { return actions_; }

  void note(Event event);
  History& history() { return history_; }
  Descriptors& descriptors() { return descriptors_; }
  Network& network() { return network_; }
  Door& door() { return door_; }
  Disk& disk() { return disk_; }

  int process() const { return process_; }
  /// A process begins. `again`: by exec, so a planned death is still to come.
  void begin_process(bool again = false);
  /// The process has ended; cuts its connections.
  void end_process();
  /// A call of the seam. The process may die in it, before or after its effect.
  void crossing();
  enum class How : std::uint8_t { Killed, PowerCut };
  /// Plans the process's death in the call of the seam after `crossings` others. `dies` is called then.
  void die_after(std::uint64_t crossings, How how, std::function<void()> dies);
  /// The same, counted from the next report that is sent.
  void die_after_report(std::uint64_t crossings, How how, std::function<void()> dies);
  /// Whether the process dies in the next call of the seam.
  bool dies_next() const { return !dead_ && dies_ && !crossings_after_report_ && crossings_left_ <= 1; }
  /// Whether the process is dead, so that its calls have no effect.
  bool is_dead() const { return dead_; }

  /// Records a violation if the process uses too much memory.
  void look_at_heap();

  std::function<void()> on_sigterm;
  std::vector<host::InheritedDescriptor> inherited;  // descriptors for a process that starts again
  std::vector<std::vector<Item>> posted_maps;

 private:
  struct Planned {
    Instant at;
    std::uint64_t order = 0;
    std::function<void()> happen;
    bool operator<(const Planned& other) const {
      return at != other.at ? at > other.at : order > other.order;
    }
  };
  void die();

  const std::uint64_t seed_;
  const Omissions without_;
  const bool has_large_maps_, has_large_grids_;
  Actions actions_;
  Instant now_;
  std::uint64_t order_ = 0, steps_ = 0, entropy_ = 0, jobs_ended_ = 0;
  std::priority_queue<Planned> planned_;
  History history_;
  Descriptors descriptors_;
  Network network_;
  Door door_;
  Disk disk_;
  double clock_ahead_ = 0;
  Instant stands_until_;
  bool in_worker_ = false;
  Duration worker_waited_{};
  How how_ = How::Killed;
  int process_ = 0;
  std::size_t heap_at_begin_ = 0;
  bool dead_ = true;
  std::uint64_t crossings_left_ = 0;
  std::optional<std::uint64_t> crossings_after_report_;
  std::function<void()> dies_;
};

}  // namespace adit::simulation
