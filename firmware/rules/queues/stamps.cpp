#include "queues/stamps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

namespace adit::queues {
namespace {

icd::Stamp stamp_of(const icd::Header& header) {
  return header.stamp.value_or(0);
}

/// The first of `size` cells along an axis whose middle is not before `place`, in metres; or `size`.
std::int64_t first_from(double place, double resolution, std::uint32_t size) {
  return static_cast<std::int64_t>(
      std::clamp(std::ceil(place / resolution - 0.5), 0.0, static_cast<double>(size)));
}

/// The parts of `area` outside of `hole`, which overlaps it.
void add_parts_outside(std::vector<Cells>& parts, const Cells& area, const Cells& hole) {
  const Cells inner = common(area, hole);
  const Cells around[] = {{area.x, area.y, area.width, inner.y - area.y},
                          {area.x, inner.top(), area.width, area.top() - inner.top()},
                          {area.x, inner.y, inner.x - area.x, inner.height},
                          {inner.right(), inner.y, area.right() - inner.right(), inner.height}};
  for (const Cells& part : around) {
    if (part.width > 0 && part.height > 0) parts.push_back(part);
  }
}

}  // namespace

std::vector<icd::GridBounds> OvertakenMaps::find_newer(const icd::MapUpdate& map,
                                                       const Upload& upload) const {
  std::vector<icd::GridBounds> newer;
  const auto client = clients_.find(upload.address);
  if (client == clients_.end()) return newer;
  const Sender sender = Sender::from_map(map);
  for (const AcceptedMap& each : client->second) {
    if (each.sender == sender && each.stamp > stamp_of(map.header()) && each.ended > upload.began)
      newer.push_back(each.bounds);
  }
  return newer;
}

bool OvertakenMaps::must_wait(const Upload& upload) const {
  return std::ranges::any_of(stored_, [&](const StoredMap& each) {
    return each.upload.address == upload.address && (each.is_overtaken || each.upload.ended > upload.began);
  });
}

void OvertakenMaps::end(const Upload& upload) {
  std::erase_if(stored_, [&](const StoredMap& each) { return each.upload.ended == upload.ended; });
}

void OvertakenMaps::record(const icd::MapUpdate& map, const Upload& upload) {
  if (const auto client = clients_.find(upload.address); client != clients_.end()) {
    std::erase_if(client->second, [&](const AcceptedMap& each) {
      return upload.overlaps == 0 || each.ended < upload.overlaps;
    });
    if (client->second.empty()) clients_.erase(client);
  }
  if (upload.overlaps == 0) return;
  if (clients_.size() == kMostClients && !clients_.contains(upload.address)) return;
  std::vector<AcceptedMap>& its = clients_[upload.address];
  if (its.size() == kMostOfClient) its.erase(its.begin());
  AcceptedMap added{.sender = Sender::from_map(map), .stamp = stamp_of(map.header()), .ended = upload.ended};
  if (const auto* grid = std::get_if<icd::OccupancyGrid>(&map.msg))
    added.bounds = icd::GridBounds::from_grid(*grid);
  its.push_back(std::move(added));
}

std::vector<Cells> cells_outside(const icd::OccupancyGrid& older, std::span<const icd::GridBounds> newer) {
  std::vector<Cells> outside{{0, 0, older.width, older.height}};
  if (!corner_at(older, 0, 0)) return outside;
  for (const icd::GridBounds& each : newer) {
    const auto part = icd::covered_part(each, older);
    if (!part) continue;
    const auto left = first_from(part->low.x, each.resolution, older.width);
    const auto bottom = first_from(part->low.y, each.resolution, older.height);
    const Cells covered{left, bottom, first_from(part->high.x, each.resolution, older.width) - left,
                        first_from(part->high.y, each.resolution, older.height) - bottom};
    std::vector<Cells> rest;
    for (const Cells& area : outside) {
      if (covered.width > 0 && covered.height > 0 && area.overlaps(covered)) {
        add_parts_outside(rest, area, covered);
      } else {
        rest.push_back(area);
      }
    }
    outside = std::move(rest);
  }
  return outside;
}

std::size_t OvertakenMarkers::remove_from(icd::MarkersUpdate& update, const Upload& upload) const {
  const auto client = clients_.find(upload.address);
  if (client == clients_.end()) return 0;
  const auto overtakes = [&](const Change& newer, const icd::Marker& older) {
    return newer.ended > upload.began && stamp_of(newer.marker.header) > stamp_of(older.header);
  };
  const auto& [changes, delete_all] = client->second;
  std::vector<icd::Marker> again;
  const std::size_t removed = std::erase_if(update.markers, [&](const icd::Marker& older) {
    if (overtakes(delete_all, older)) return true;
    if (older.action != icd::MarkerAction::DeleteAll) {
      const auto newer = changes.find({older.ns, older.id});
      return newer != changes.end() && overtakes(newer->second, older);
    }
    again.clear();
    for (const auto& [key, newer] : changes) {
      if (newer.stands && overtakes(newer, older)) again.push_back(newer.marker);
    }
    return false;
  });
  std::ranges::move(again, std::back_inserter(update.markers));
  return removed;
}

void OvertakenMarkers::record(const icd::MarkersUpdate& update, const Upload& upload) {
  if (upload.overlaps == 0) forget(upload.address);
  if (upload.overlaps == 0 && clients_.empty()) return;
  for (const icd::Marker& marker : update.markers) {
    replace_others(marker, upload.address);
    if (upload.overlaps == 0) continue;
    if (marker.action == icd::MarkerAction::DeleteAll) {
      forget(upload.address);
      clients_[upload.address].delete_all = {marker, upload.ended};
    } else {
      Change& change = clients_[upload.address].changes[{marker.ns, marker.id}];
      bytes_ += icd::bytes_of(marker) - (change.ended == 0 ? 0 : icd::bytes_of(change.marker));
      change = {marker, upload.ended};
    }
  }
  if (bytes_ <= kMostBytes) return;
  clients_.clear();
  bytes_ = 0;
}

void OvertakenMarkers::replace_others(const icd::Marker& newer, const std::string& address) {
  for (auto& [other, client] : clients_) {
    if (other == address) continue;
    if (newer.action == icd::MarkerAction::DeleteAll) {
      for (auto& [key, change] : client.changes) change.stands = false;
    } else if (const auto same = client.changes.find({newer.ns, newer.id}); same != client.changes.end()) {
      same->second.stands = false;
    }
  }
}

void OvertakenMarkers::forget(const std::string& address) {
  const auto client = clients_.find(address);
  if (client == clients_.end()) return;
  for (const auto& [key, change] : client->second.changes) bytes_ -= icd::bytes_of(change.marker);
  clients_.erase(client);
}

StampShift::Address& StampShift::address_of(const std::string& address) {
  if (addresses_.size() >= kMostAddresses && !addresses_.contains(address)) {
    addresses_.erase(
        std::ranges::min_element(addresses_, {}, [](const auto& each) { return each.second.used; }));
  }
  Address& its = addresses_[address];
  its.used = ++uses_;
  return its;
}

StampShift::ClockKey StampShift::name_in(const Address& address, const Stamper& stamper) {
  constexpr std::size_t kShared = std::size(icd::kUris);
  const ClockKey own{stamper.uri, stamper.robot};
  const bool has_room = address.clocks.size() + kShared < kMostOfAddress;
  return has_room || address.clocks.contains(own) ? own : ClockKey{stamper.uri, ""};
}

StampShift::Clock* StampShift::find(const Stamper& stamper) {
  const auto address = addresses_.find(stamper.address);
  if (address == addresses_.end()) return nullptr;
  Address& its = address->second;
  its.used = ++uses_;
  const auto clock = its.clocks.find(name_in(its, stamper));
  return clock == its.clocks.end() ? nullptr : &clock->second;
}

bool StampShift::is_set_back(Clock& clock, icd::Stamp stamp, double now, const Upload& upload) {
  if (stamp >= clock.latest) clock.older.reset();
  if (stamp >= clock.latest || stamp < clock.latest - kOldest) return stamp < clock.latest;
  const auto& older = clock.older;
  if (!older || stamp < older->stamp || stamp - older->stamp > now - older->at + kJitter)
    clock.older = OlderStamp{stamp, now, upload.ended};
  // A slow upload was stamped long before now.
  return upload.began >= clock.older->ended && stamp - clock.older->stamp >= kSteady;
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
  const bool fits_only_before = std::abs(shifted - now) > kJump;
  // The clock was set back, but no message had shown it yet.
  const bool is_not_shown_yet = *stamp < clock->theirs && before < shifted;
  const bool is_of_before = upload.began < clock->stepped && (fits_only_before || is_not_shown_yet) &&
                            before <= clock->before.latest_given() + kJump;
  if (is_of_before) return std::max(before, 0.0);
  const bool steps = is_set_back(*clock, *stamp, now, upload) || shifted > now + kJump;
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

StampShift::Clocks StampShift::take_changed() {
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

std::optional<double> StampShift::sender_time(double now, double from, double until) const {
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

void StampShift::restore(const Stamper& stamper, const SenderClock& clock) {
  address_of(stamper.address).clocks[{stamper.uri, stamper.robot}] = Clock{clock};
}

void StampShift::restore_stamp(const Stamper& stamper, icd::Stamp stamp) {
  if (Clock* const clock = find(stamper))
    clock->latest = std::max(clock->latest, clock->theirs + (stamp - clock->ours));
}

}  // namespace adit::queues
