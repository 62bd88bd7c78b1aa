#include "forward/clocks.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "dispatch/runs.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "store/frame.hpp"

namespace adit::forward {

std::expected<StampFloor::StoredFloor, std::string> StampFloor::read() const {
  if (!host::can_exist(file_)) return StoredFloor{};
  const auto text = ADIT_TRY(host::read_file(file_));
  const auto one = store::value_in<StoredFloor>(text),
             other = store::value_in<StoredFloor>(text, store::kOnDisk.align);
  if (!one || !other)
    host::log(host::Level::Warning, "a copy of the last time stamps is damaged",
              {{"file", file_}, {"now", one || other ? "the other copy is used" : "stamps may go back"}});
  const StoredFloor none{.is_damaged = true}, &first = one ? *one : none, &second = other ? *other : none;
  return first.floor < second.floor ? second : first;  // a power cut may have left an older copy
}

std::optional<StampFloor::StoredFloor> StampFloor::due(double now, double wall,
                                                       const ledger::LedgerFacts& ledger) {
  const bool is_soon = ledger != ledger_ || outcome_->has_failed;
  if (now < last_ + (is_soon ? kSoon : kEvery)) return {};
  last_ = now;
  ledger_ = ledger;
  return StoredFloor{.floor = now + kAhead, .wall = wall, .ledger = ledger};
}

void StampFloor::write(const StoredFloor& kept) {
  const std::string file = store::file_of(kept, store::kOnDisk);
  auto written = host::write_file(file_, file, host::kOursAlone);
  if (!written && host::overwrite(file_, file)) written = {};  // for a full disk
  const std::string why = written ? "" : written.error();
  outcome_->has_failed = !written;
  if (std::exchange(outcome_->trouble, why) == why || written) return;
  host::log(host::Level::Warning,
            "cannot store the last time stamps; after a power cut, time stamps may run backward",
            {{"why", written.error()}});
}

void StampFloor::remember(const ledger::LedgerFacts& ledger) {
  auto kept = read();
  if (!kept || kept->is_damaged) return;
  const ledger::LedgerFacts latest = ledger::latest_of(kept->ledger, ledger);
  if (std::exchange(kept->ledger, latest) != latest) write(*kept);
}

void StampFloor::forget() {
  const auto kept = read();
  if (!kept || kept->lead.value_or(0) <= kMostAhead) return;
  host::log(host::Level::Notice, "the bound of time stamps is forgotten; time stamps step back once");
  write({.ledger = kept->ledger, .overruled = kept->floor});
}

// Dispatch subtracts the step of a boot from a silence.
static_assert(StampFloor::kAhead <= dispatch::kClockAhead);

void Clocks::restore(journal::HandoverState& carried, const std::string& boot, double newest) {
  const StampFloor::StoredFloor kept = kept_.value_or(StampFloor::StoredFloor());
  carried.set_boot(boot);
  const auto& clock = carried.clock();
  boot_ = clock || kept_ ? boot : "unknown";  // without the bound the clock is not carried on
  ran_before_ = clock || !kept_ || kept.floor > 0 || newest > 0;
  lead_ = kept.lead;
  if (clock) {
    senders_ = carried.senders();
    loop_.set_stamp(clock->stamp + std::chrono::duration<double>(loop_.now() - clock->at).count());
    clock_step_ = {.to = clock->step_to, .by = clock->step_by};
    off_ = {.seconds = clock->off, .since = clock->off_since};
  } else {
    begin_start(kept, newest);
  }
  if (kept.least > loop_.stamp_now()) {
    loop_.set_stamp(kept.least);
    senders_ = {};  // offsets to the earlier clock
  }
  journal_.begin(now());
}

journal::Clock Clocks::now() const {
  return {.boot = boot_,
          .at = loop_.now(),
          .stamp = loop_.stamp_now(),
          .step_to = clock_step_.to,
          .step_by = clock_step_.by,
          .off = off_.seconds,
          .off_since = off_.since};
}

/// Whether stamps must not follow the box's clock: it is ahead by more than a season, and no other source has
/// told a time near it. If one tells it during this boot, the next boot follows the clock.
bool Clocks::is_far_beyond(double floor, const StampFloor::StoredFloor& kept) const {
  const double known = std::max(floor, kept.floor - kept.lead.value_or(0));
  if (floor <= 0 || loop_.stamp_now() <= known + kSeason) return false;
  host::log(host::Level::Warning, "the clock is far ahead of the last time stamps; they go on from these");
  return true;
}

/// A boot may set both clocks back. The file corrects them, or else the ledger. Time off comes from the time
/// of day, which may have been set long after the stamps began.
void Clocks::begin_start(const StampFloor::StoredFloor& kept, double newest) {
  const double proven = newest > kept.overruled ? newest : 0, floor = std::max(kept.floor, proven);
  // A start uses stamps from the bound on before it stores the next one.
  if (kept_ && floor > kept.floor + (kept.floor > 0 ? StampFloor::kAhead : 0))
    damage_ = kept.floor > 0 ? "their file is older than the ledger" : "their file is missing or damaged";
  if (kept.is_damaged) damage_ = "their file is damaged";
  const bool is_far = is_far_beyond(floor, kept);
  if (floor > loop_.stamp_now() || is_far) loop_.set_stamp(floor);
  if (kept.wall > loop_.wall_now()) loop_.set_wall(kept.wall);
  if (kept.floor <= 0 || kept.wall <= 0) return;
  const double went_on = loop_.stamp_now() - (kept.floor - StampFloor::kAhead);
  const double went_by = loop_.wall_now() - kept.wall;
  clock_step_ = {.to = loop_.stamp_now(), .by = std::max(0.0, went_on)};
  const double most = is_far ? went_by : clock_step_.by;
  off_ = {.seconds = std::max(0.0, std::min(went_by, most)), .since = kept.wall};
}

double Clocks::time_of_day(double stamp) const {
  const double now = loop_.stamp_now();
  const double machine_began = now - std::chrono::duration<double>(loop_.now().time_since_epoch()).count();
  const bool is_of_this_clock = stamp >= machine_began && (!kept_ || stamp >= kept_->least);
  return is_of_this_clock ? stamp + loop_.wall_now() - now : stamp;
}

bool Clocks::correct(double there) {
  if (off_.seconds <= 0) return false;
  const double off_there = there - off_.since - (loop_.stamp_now() - clock_step_.to);
  clock_step_.by -= std::clamp(off_there, 0.0, off_.seconds);
  off_ = {};
  journal_.clock(now());
  return true;
}

void Clocks::stamp(icd::MapUpdate& update, const queues::Upload& upload) {
  const queues::Stamper stamper{upload.address, icd::Uri::MapUpdate, icd::text_of(update.name)};
  std::optional<icd::Stamp>& stamp = update.header().stamp;
  stamp = senders_.shift(stamper, stamp, loop_.stamp_now(), upload);
  keep();
}

std::vector<queues::PostedPose> Clocks::stamp_poses(const icd::StateUpdate& update,
                                                    const queues::Upload& upload) {
  const std::optional<icd::Stamp> stamp = update.header.stamp;
  const double now = loop_.stamp_now();
  std::vector<queues::PostedPose> poses;
  poses.reserve(update.poses.size());
  for (const icd::NamedPose& named : update.poses) {
    const queues::Stamper stamper{upload.address, icd::Uri::StateUpdate, named.name.text()};
    poses.push_back({.name = named.name,
                     .pose = named.pose,
                     .stamp = senders_.shift(stamper, stamp, now, upload),
                     .address = queues::is_set(stamp) ? upload.address : ""});
  }
  keep();
  return poses;
}

void Clocks::stamp(icd::MarkersUpdate& update, const queues::Upload& upload) {
  senders_.shift_each({upload.address, icd::Uri::MarkersUpdate, ""}, update.markers, loop_.stamp_now(),
                      upload);
  keep();
}

void Clocks::keep(loop::Writer& writer, const ledger::LedgerFacts& ledger) {
  if (!kept_) return;
  auto due = floor_.due(loop_.stamp_now(), loop_.wall_now(), ledger);
  if (!due) return;
  due->least = kept_->least;
  due->lead = lead_;
  due->overruled = kept_->overruled;
  writer.submit([floor = floor_, due = *due]() mutable { floor.write(due); }, [] {});
}

}  // namespace adit::forward
