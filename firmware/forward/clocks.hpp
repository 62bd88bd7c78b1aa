#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clock/source.hpp"
#include "dispatch/report.hpp"
#include "forward/stamp_floor.hpp"
#include "icd/markers_update.hpp"
#include "icd/state_update.hpp"
#include "intake/desk.hpp"
#include "journal/journal.hpp"
#include "lanes/posted_pose.hpp"
#include "lanes/stamps.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::forward {

/// The gateway's clock for stamps, and the senders' clocks brought to it. All go on after a restart of the
/// service, the gateway's also after one of the machine (promise 5), whatever becomes of the time of day.
class Clocks {
 public:
  /// `loop` and `journal` outlive this.
  Clocks(loop::Loop& loop, journal::Journal& journal, const std::string& state_folder)
      : loop_(loop), journal_(journal), floor_(state_folder), kept_(floor_.read()) {}

  /// Why the bound of the stamps cannot be read, as a sentence; or "". Then no stamp may be sent, and the
  /// file stays as it is: the next process reads it again.
  std::string unread() const { return kept_ ? "" : "the last time stamps cannot be read: " + kept_.error(); }
  /// Goes on where the life before ended, and begins the journal of this one. `boot`: the machine's.
  void carry_on(journal::Carried& carried, const std::string& boot);

  /// With which the clock for stamps began at this start of the machine. How long that was off is not known
  /// before the Command Post bears it out: the machine's clock may be wrong by a year.
  const dispatch::Leap& leap() const { return leap_; }
  /// It is that time of day at the Command Post. True: leap() is another for it.
  bool hear(double there);
  /// Whether this box may have sent something in a life before.
  bool ran_before() const { return ran_before_; }

  /// Each brings a message's stamps to the gateway's clock. The journal keeps the offsets of its sender.
  void stamp(icd::MapUpdate& update, const intake::Sender& sender);
  std::vector<lanes::PostedPose> stamped(const icd::StateUpdate& update, const intake::Sender& sender);
  void stamp(icd::MarkersUpdate& update, const intake::Sender& sender);

  /// To be called now and then. Writes by the disk's own writer, because a disk may be slow.
  void keep(loop::Writer& writer, const ledger::Known& ledger);
  /// The time of day was set: what was kept of it is wrong.
  void wall_was_set() { floor_.is_due(); }
  /// The time of day by the stamps of a robot that has spoken for a while: of several, the earliest that a
  /// set clock may show.
  std::optional<double> told_by_robots() const {
    return senders_.told(loop_.stamp_now(), clock::kEarliest, clock::kLatest);
  }

 private:
  /// As long as it is not borne out: for so many seconds the machine was off, by its own clock, since that
  /// time of day.
  struct Off {
    double seconds = 0, since = 0;
  };
  void begin_start(const StampFloor::Kept& kept);
  journal::Clock now() const;
  void keep() { journal_.senders(senders_.changed()); }

  loop::Loop& loop_;
  journal::Journal& journal_;
  StampFloor floor_;
  const std::expected<StampFloor::Kept, std::string> kept_;  // as the process before left it
  lanes::StampShift senders_;
  dispatch::Leap leap_;
  Off off_;
  std::string boot_;
  bool ran_before_ = false;
};

}  // namespace adit::forward
