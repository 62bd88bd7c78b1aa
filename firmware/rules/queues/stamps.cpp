#include "queues/stamps.hpp"

#include <algorithm>
#include <cmath>

namespace adit::queues {

StampShift::Address& StampShift::address_of(const std::string& address) {
  if (addresses_.size() >= kMostAddresses && !addresses_.contains(address)) {
    addresses_.erase(
        std::ranges::min_element(addresses_, {}, [](const auto& each) { return each.second.used; }));
  }
  Address& its = addresses_[address];
  its.used = ++uses_;
  return its;
}

StampShift::Named StampShift::name_in(const Address& address, const Stamper& stamper) {
  constexpr std::size_t kShared = std::size(icd::kUris);
  const Named own{stamper.uri, stamper.robot};
  const bool has_room = address.clocks.size() + kShared < kMostOfAddress;
  return has_room || address.clocks.contains(own) ? own : Named{stamper.uri, ""};
}

StampShift::Clock* StampShift::find(const Stamper& stamper) {
  const auto address = addresses_.find(stamper.address);
  if (address == addresses_.end()) return nullptr;
  Address& its = address->second;
  its.used = ++uses_;
  const auto clock = its.clocks.find(name_in(its, stamper));
  return clock == its.clocks.end() ? nullptr : &clock->second;
}

bool StampShift::is_set_back(Clock& clock, icd::Stamp stamp, double now) {
  if (stamp >= clock.latest) clock.older.reset();
  if (stamp >= clock.latest || stamp < clock.latest - kOldest) return stamp < clock.latest;
  const auto& older = clock.older;
  if (!older || stamp < older->stamp || stamp - older->stamp > now - older->at + kJitter)
    clock.older = Older{stamp, now};
  return stamp - clock.older->stamp >= kSteady;
}

icd::Stamp StampShift::shift(Clock*& clock, const Stamper& stamper, std::optional<icd::Stamp> stamp,
                             double now, const Upload& upload) {
  if (!is_set(stamp)) return clock == nullptr ? now : std::max(now, clock->latest_given());
  const bool is_new = clock == nullptr;
  if (is_new) {
    Address& its = address_of(stamper.address);
    clock = &its.clocks[name_in(its, stamper)];
    clock->ours = now;
    clock->theirs = clock->latest = *stamp;
  }
  // The difference comes first, because the sum with a distant stamp would lose fractions of a second.
  icd::Stamp shifted = clock->ours + (*stamp - clock->theirs);
  const icd::Stamp before = clock->before.ours + (*stamp - clock->before.theirs);
  const bool is_of_before = upload.began < clock->stepped && std::abs(shifted - now) > kJump &&
                            before <= clock->before.latest_given() + kJump;
  if (is_of_before) return std::max(before, 0.0);
  const bool steps = is_set_back(*clock, *stamp, now) || shifted > now + kJump;
  if (steps) {
    clock->older.reset();
    clock->before = static_cast<const SenderClock&>(*clock);
    clock->stepped = upload.ended;
    shifted = clock->ours = std::max(now, clock->latest_given());
    clock->theirs = clock->latest = *stamp;
  }
  clock->latest = std::max(clock->latest, *stamp);
  const bool to_record = is_new || steps || stamper.uri != icd::Uri::StateUpdate;
  if (to_record && !std::exchange(clock->has_changed, true)) changed_.push_back(stamper);
  return std::max(shifted, 0.0);  // ICD 6.2: a stamp is never negative
}

icd::Stamp StampShift::shift(const Stamper& stamper, std::optional<icd::Stamp> stamp, double now,
                             const Upload& upload) {
  Clock* clock = find(stamper);
  return shift(clock, stamper, stamp, now, upload);
}

void StampShift::shift_each(const Stamper& stamper, std::span<icd::Marker> markers, double now,
                            const Upload& upload) {
  Clock* clock = find(stamper);
  for (icd::Marker& marker : markers)
    marker.header.stamp = shift(clock, stamper, marker.header.stamp, now, upload);
}

StampShift::Clocks StampShift::changed() {
  Clocks clocks;
  for (Stamper& stamper : std::exchange(changed_, {})) {
    Clock* const clock = find(stamper);
    if (clock == nullptr || !std::exchange(clock->has_changed, false)) continue;
    stamper.robot = name_in(addresses_.at(stamper.address), stamper).second;
    clocks.emplace_back(std::move(stamper), *clock);
  }
  return clocks;
}

StampShift::Clocks StampShift::clocks() const {
  std::vector<std::pair<std::uint64_t, const std::string*>> by_use;
  by_use.reserve(addresses_.size());
  for (const auto& [address, its] : addresses_) by_use.emplace_back(its.used, &address);
  std::ranges::sort(by_use);
  Clocks clocks;
  for (const auto& [used, address] : by_use) {
    for (const auto& [name, clock] : addresses_.at(*address).clocks)
      clocks.emplace_back(Stamper{*address, name.first, name.second}, clock);
  }
  return clocks;
}

std::optional<double> StampShift::told(double now, double from, double until) const {
  std::optional<double> earliest;
  for (const auto& [address, its] : addresses_) {
    for (const auto& [name, clock] : its.clocks) {
      const double silent = now - clock.latest_given();
      if (clock.latest - clock.theirs < kSpeaks || std::abs(silent) > kSpeaks) continue;
      const double shows = clock.latest + silent;
      if (!(shows >= from && shows < until)) continue;
      earliest = std::min(earliest.value_or(shows), shows);
    }
  }
  return earliest;
}

void StampShift::carry_on(const Stamper& stamper, const SenderClock& clock) {
  address_of(stamper.address).clocks[{stamper.uri, stamper.robot}] = Clock{clock};
}

void StampShift::given(const Stamper& stamper, icd::Stamp stamp) {
  if (Clock* const clock = find(stamper))
    clock->latest = std::max(clock->latest, clock->theirs + (stamp - clock->ours));
}

icd::Stamp StampOrder::next(icd::Stamp stamp) {
  return last_ = std::max(last_, stamp);
}

}  // namespace adit::queues
