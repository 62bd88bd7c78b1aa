#pragma once

#include <atomic>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "clock/messages.hpp"
#include "dispatch/report.hpp"
#include "icd/mapping.hpp"
#include "journal/journal.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "queues/stamps.hpp"
#include "queues/state_queue.hpp"
#include "store/frame.hpp"

namespace adit::forward {

/// Prevents stamps from running back after a boot (promise 5). A box without a battery-backed clock has about
/// the same time at each boot. A file in the state directory holds a bound above all stamps, ahead of them,
/// so that it is written seldom and without a wait. The file also has the time of day. It is one frame of a
/// log (store/README.md) in two copies, with salt 0.
class StampFloor {
 public:
  struct StoredFloor {
    double floor = 0, wall = 0;       // seconds since 1970; 0: unknown
    double least = 0;                 // lowest allowed stamp, for stamps of another box
    ledger::LedgerFacts ledger = {};  // a ledger with less is damaged
    /// Seconds by which stamps were ahead of the time of day, by the last source that told it.
    std::optional<double> lead = {};
    double overruled = 0;     // times in the ledger up to it are no stamps, after forget()
    bool is_damaged = false;  // no copy is good; not in the file

    friend bool operator==(const StoredFloor&, const StoredFloor&) = default;
  };
  static constexpr const char* kFile = "stamps";
  static constexpr double kEvery = 150;  // seconds
  static constexpr double kSoon = 10;    // seconds, if the ledger has grown or the last write failed
  /// Stamps may be kJump ahead of now, and a disk may be slow.
  static constexpr double kAhead = queues::StampShift::kJump + kEvery + 15;
  static constexpr double kMostAhead = 86400;  // seconds beyond the time of day; more needs an operator

  explicit StampFloor(const std::string& state_folder) : file_(state_folder + '/' + kFile) {}

  /// Logs a damaged copy and uses the other one. All values are 0 without a good copy. An error: the file is
  /// unreadable, and must not be written.
  std::expected<StoredFloor, std::string> read() const;

  /// The values to write now, if due. `now`: stamp clock; `wall`: time of day.
  std::optional<StoredFloor> due(double now, double wall, const ledger::LedgerFacts& ledger);
  /// The next due() returns values.
  void make_due() { last_ = 0; }
  /// May run on a worker, one call at a time, on copies. Logs a failure when its text changes.
  void write(const StoredFloor& kept);
  /// Stores these facts about the ledger, if the file is good and has less. For a process that could not read
  /// the file at its start, on the thread of write().
  void remember(const ledger::LedgerFacts& ledger);
  /// Removes a bound that is more than kMostAhead beyond the time of day, for the operator: stamps step back
  /// once. Call before Clocks. Logs a failure.
  void forget();

 private:
  std::string file_;
  struct Outcome {
    std::string trouble;  // the writer's
    std::atomic<bool> has_failed = false;
  };
  std::shared_ptr<Outcome> outcome_ = std::make_shared<Outcome>();
  double last_ = 0;
  ledger::LedgerFacts ledger_;
};

}  // namespace adit::forward

namespace adit {

template <>
inline constexpr auto store::kMembers<forward::StampFloor::StoredFloor> =
    std::tuple(&forward::StampFloor::StoredFloor::floor, &forward::StampFloor::StoredFloor::wall,
               &forward::StampFloor::StoredFloor::least, &forward::StampFloor::StoredFloor::ledger,
               &forward::StampFloor::StoredFloor::lead, &forward::StampFloor::StoredFloor::overruled);
/// `is_damaged` is not in the file.
template <>
inline constexpr std::size_t store::kMemberCount<forward::StampFloor::StoredFloor> = 6;

}  // namespace adit

namespace adit::forward {

/// The stamp clock, and senders' offsets to it. They survive restarts; the stamp clock survives boots
/// (promise 5), whatever the time of day does.
class Clocks {
 public:
  /// `loop` and `journal` outlive this.
  Clocks(loop::Loop& loop, journal::Journal& journal, const std::string& state_folder)
      : loop_(loop), journal_(journal), floor_(state_folder), kept_(floor_.read()) {}

  /// Why the bound of stamps is unreadable, or "". Then send no stamps. The next process gets the file.
  std::string unread() const { return kept_ ? "" : "the last time stamps cannot be read: " + kept_.error(); }
  /// Why stamps may have gone back at this start, or "".
  const std::string& damage() const { return damage_; }
  /// Call now and then. `time`: the time of day, if another source than the box's own clock told it.
  void set_known_time(double time) { lead_ = loop_.stamp_now() - time, is_told_ = true; }
  /// Seconds by which stamps are ahead of that time; 0: not more than StampFloor::kMostAhead, or not told.
  double lead() const { return is_told_ && *lead_ > StampFloor::kMostAhead ? *lead_ : 0; }
  /// Continues the clocks of the previous process and begins the journal. `boot`: the boot id.
  /// `newest`: the newest stamp in the ledger; 0: none.
  void restore(journal::HandoverState& carried, const std::string& boot, double newest);

  /// The stamp clock's step at this boot. The Command Post must confirm the time off, because the box's clock
  /// may be wrong by a year.
  const dispatch::ClockStep& clock_step() const { return clock_step_; }
  /// `there`: the Command Post's time of day. True: clock_step() changed.
  bool correct(double there);
  /// True if this box may have sent messages before this process.
  bool has_run_before() const { return ran_before_; }

  /// The present time of day of a stamp in the ledger. Stamps of earlier boots and other boxes are unchanged.
  double time_of_day(double stamp) const;

  /// Convert stamps to the stamp clock, and journal the sender's offsets.
  void stamp(icd::MapUpdate& update, const queues::Upload& upload);
  std::vector<queues::PostedPose> stamp_poses(const icd::StateUpdate& update, const queues::Upload& upload);
  void stamp(icd::MarkersUpdate& update, const queues::Upload& upload);

  /// Writes the bound of the stamps if it is due. Call now and then. The writer's thread waits for the disk.
  void keep(loop::Writer& writer, const ledger::LedgerFacts& ledger);
  /// The file is written at the next keep().
  void on_wall_set() { floor_.make_due(); }
  /// The time of day by the stamps of robots: the earliest plausible one.
  std::optional<double> robots_time() const {
    return senders_.sender_time(loop_.stamp_now(), clock::kEarliest, clock::kLatest);
  }

 private:
  /// Time off by the box's clock, until confirmed.
  struct Deviation {
    double seconds = 0, since = 0;
  };
  static constexpr double kSeason = clock::kRobotsMost;  // seconds that a box may be stored
  void begin_start(const StampFloor::StoredFloor& kept, double newest);
  bool is_far_beyond(double floor, const StampFloor::StoredFloor& kept) const;
  journal::Clock now() const;
  void keep() { journal_.record_senders(senders_.take_changed()); }

  loop::Loop& loop_;
  journal::Journal& journal_;
  StampFloor floor_;
  const std::expected<StampFloor::StoredFloor, std::string> kept_;  // from the previous process
  std::string damage_;
  std::optional<double> lead_;  // StampFloor::StoredFloor::lead
  bool is_told_ = false;        // in this process
  queues::StampShift senders_;
  dispatch::ClockStep clock_step_;
  Deviation off_;
  std::string boot_;
  bool ran_before_ = false;
};

}  // namespace adit::forward
