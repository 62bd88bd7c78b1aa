#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clock/messages.hpp"
#include "dispatch/report.hpp"
#include "forward/stamp_floor.hpp"
#include "icd/mapping.hpp"
#include "journal/journal.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "queues/stamps.hpp"
#include "queues/state_queue.hpp"

namespace adit::forward {

/// The stamp clock, and senders' offsets to it. They survive restarts; the stamp clock survives boots
/// (promise 5), whatever the time of day does.
class Clocks {
 public:
  /// `loop` and `journal` outlive this. `newest`: the newest stamp in the ledger; 0: none.
  Clocks(loop::Loop& loop, journal::Journal& journal, const std::string& state_folder, double newest)
      : loop_(loop), journal_(journal), floor_(state_folder), kept_(floor_.read()), newest_(newest) {}

  /// Why the bound of stamps is unreadable, or "". Then send no stamps. The file is left for the next
  /// process.
  std::string unread() const { return kept_ ? "" : "the last time stamps cannot be read: " + kept_.error(); }
  /// Why stamps may have gone back at this start, or "".
  const std::string& damage() const { return damage_; }
  /// Call now and then. `time`: the time of day, if another source than the box's own clock told it.
  void set_known_time(double time) { lead_ = loop_.stamp_now() - time, is_told_ = true; }
  /// Seconds by which stamps are ahead of that time; 0: not more than StampFloor::kMostAhead, or not told.
  double lead() const { return is_told_ && *lead_ > StampFloor::kMostAhead ? *lead_ : 0; }
  /// Continues the clocks of the previous process and begins the journal. `boot`: the boot id.
  void carry_on(journal::Carried& carried, const std::string& boot);

  /// The stamp clock's step at this boot. The Command Post must confirm the time off, because the box's clock
  /// may be wrong by a year.
  const dispatch::ClockStep& clock_step() const { return clock_step_; }
  /// `there`: the Command Post's time of day. True: clock_step() changed.
  bool hear(double there);
  /// True if this box may have sent messages before this process.
  bool ran_before() const { return ran_before_; }

  /// Convert stamps to the stamp clock, and journal the sender's offsets.
  void stamp(icd::MapUpdate& update, const queues::Upload& upload);
  std::vector<queues::PostedPose> stamped(const icd::StateUpdate& update, const queues::Upload& upload);
  void stamp(icd::MarkersUpdate& update, const queues::Upload& upload);

  /// Writes the bound of the stamps if it is due. Call now and then. The writer's thread waits for the disk.
  void keep(loop::Writer& writer, const ledger::Known& ledger);
  /// The file is written at the next keep().
  void wall_was_set() { floor_.is_due(); }
  /// The time of day by the stamps of robots: the earliest plausible one.
  std::optional<double> told_by_robots() const {
    return senders_.told(loop_.stamp_now(), clock::kEarliest, clock::kLatest);
  }

 private:
  /// Time off by the box's clock, until confirmed.
  struct Off {
    double seconds = 0, since = 0;
  };
  static constexpr double kSeason = clock::kRobotsMost;  // seconds that a box may be stored
  void begin_start(const StampFloor::Kept& kept);
  bool is_far_beyond(double floor, const StampFloor::Kept& kept) const;
  journal::Clock now() const;
  void keep() { journal_.senders(senders_.changed()); }

  loop::Loop& loop_;
  journal::Journal& journal_;
  StampFloor floor_;
  const std::expected<StampFloor::Kept, std::string> kept_;  // from the previous process
  const double newest_;
  std::optional<double> lead_;  // StampFloor::Kept::lead
  bool is_told_ = false;        // in this process
  std::string damage_;
  queues::StampShift senders_;
  dispatch::ClockStep clock_step_;
  Off off_;
  std::string boot_;
  bool ran_before_ = false;
};

}  // namespace adit::forward
