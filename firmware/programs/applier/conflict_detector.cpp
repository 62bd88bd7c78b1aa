#include "applier/conflict_detector.hpp"

#include <algorithm>
#include <utility>

#include "network/messages.hpp"

namespace adit::applier {
namespace {

constexpr std::size_t kFirstAsks = ConflictDetector::kFirstGaps.size() + 1;

}  // namespace

void ConflictDetector::set_own(const std::vector<std::uint32_t>& addresses, std::vector<Mac> macs,
                               Instant now) {
  macs_ = std::move(macs);
  std::vector<Own> next;
  for (const std::uint32_t address : addresses) {
    if (next.size() == kMost) break;
    const auto known = std::ranges::find(own_, address, &Own::address);
    next.push_back(known != own_.end() ? *known
                                       : Own{.address = address, .first_asks = kFirstAsks, .ask_at = now});
  }
  own_ = std::move(next);
}

void ConflictDetector::ask_again(Instant now) {
  for (Own& own : own_) {
    own.first_asks = kFirstAsks;
    own.ask_at = now;
  }
}

void ConflictDetector::hear(const ArpPacket& packet, Instant now) {
  if (std::ranges::find(macs_, packet.sender) != macs_.end()) return;
  for (Own& own : own_) {
    if (packet.from == own.address) {
      note(own, packet.sender, now);
    } else if (packet.probes(own.address)) {
      ask_soon(own, now);  // if another machine has the address in spite of our kernel's answer, it answers a
                           // request
    }
  }
}

/// Of several machines, reports the first until it falls silent.
void ConflictDetector::note(Own& own, const Mac& by, Instant now) {
  if (!own.taken || now >= own.by_seen + network::kTakenFor)
    own.taken = Conflict{.address = own.address, .by = by, .since = now};
  own.taken->seen = now;
  if (own.taken->by == by) own.by_seen = now;
  ask_soon(own, now);
}

void ConflictDetector::ask_soon(Own& own, Instant now) {
  const Instant soon = own.asked_at ? std::max(now, *own.asked_at + kBetween) : now;
  own.ask_at = own.ask_at ? std::min(*own.ask_at, soon) : soon;
}

std::vector<std::uint32_t> ConflictDetector::take_due(Instant now) {
  std::vector<std::uint32_t> due;
  for (Own& own : own_) {
    if (own.taken && now >= own.taken->seen + network::kTakenFor) own.taken.reset();
    if (!own.ask_at || now < *own.ask_at) continue;
    due.push_back(own.address);
    own.asked_at = now;
    own.ask_at.reset();
    if (own.first_asks > 0) --own.first_asks;
    if (own.first_asks > 0) own.ask_at = now + kFirstGaps[kFirstGaps.size() - own.first_asks];
    if (own.taken) ask_soon(own, now);
  }
  return due;
}

std::optional<ConflictDetector::Instant> ConflictDetector::wake() const {
  std::optional<Instant> first;
  const auto at = [&first](Instant when) { first = first ? std::min(*first, when) : when; };
  for (const Own& own : own_) {
    if (own.ask_at) at(*own.ask_at);
    if (own.taken) at(own.taken->seen + network::kTakenFor);
  }
  return first;
}

std::vector<ConflictDetector::Conflict> ConflictDetector::taken() const {
  std::vector<Conflict> all;
  for (const Own& own : own_) {
    if (own.taken) all.push_back(*own.taken);
  }
  return all;
}

}  // namespace adit::applier
