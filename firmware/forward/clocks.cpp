#include "forward/clocks.hpp"

#include <chrono>
#include <set>
#include <string_view>

namespace adit::forward {

void Clocks::carry_on(journal::Carried& carried, const std::string& boot) {
  const double floor = floor_.read();
  carried.machine_is(boot);
  const auto& clock = carried.clock();
  ran_before_ = clock || floor > 0;
  if (clock) {
    const double due = clock->stamp + std::chrono::duration<double>(loop_.now() - clock->at).count();
    const double set_ahead = loop_.stamp_now() - due;
    senders_ = carried.senders();
    if (set_ahead < kWasSet) {
      loop_.set_stamp(due);
    } else {
      senders_.move(set_ahead);
    }
  } else if (floor > loop_.stamp_now()) {
    loop_.set_stamp(floor);  // the machine has no clock that went on
  }
  journal_.begin({.boot = boot, .at = loop_.now(), .stamp = loop_.stamp_now()});
  for (const auto& [sender, its] : senders_.clocks()) journal_.sender(sender, its);  // they may have moved
}

icd::Stamp Clocks::stamped(const std::string& sender, std::optional<icd::Stamp> stamp,
                           std::uint64_t connection) {
  const icd::Stamp shifted = senders_.shift(sender, stamp, loop_.stamp_now(), connection);
  keep(sender);
  return shifted;
}

void Clocks::stamp(icd::MarkersUpdate& update, const std::string& address) {
  std::set<std::string> senders;
  std::string_view ns;
  auto sender = senders.end();
  const double now = loop_.stamp_now();
  for (icd::Marker& marker : update.markers) {
    if (sender == senders.end() || marker.ns != ns) {
      sender = senders.insert(address + "/markers/" + marker.ns).first;
      ns = marker.ns;
    }
    marker.header.stamp = senders_.shift(*sender, marker.header.stamp, now);
  }
  for (const std::string& each : senders) keep(each);
}

void Clocks::keep(const std::string& sender) {
  if (const lanes::SenderClock* its = senders_.clock_of(sender)) journal_.sender(sender, *its);
}

void Clocks::keep_floor(loop::Writer& writer) {
  const auto floor = floor_.due(loop_.stamp_now());
  if (floor) writer.submit([kept = floor_, floor = *floor]() mutable { kept.write(floor); }, [] {});
}

}  // namespace adit::forward
