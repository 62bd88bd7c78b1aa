#include "applier/exchanged.hpp"

#include <algorithm>

#include "network/messages.hpp"

namespace adit::applier {

void Exchanged::set_sought(const std::vector<std::uint32_t>& addresses, const std::vector<Mac>& macs,
                           Instant now) {
  at_team_.set_own(addresses, macs, now);
  macs_ = macs;
  std::vector<AtPost> next;
  for (const std::uint32_t address : addresses) {
    const auto known = std::ranges::find(at_post_, address, &AtPost::address);
    next.push_back(known != at_post_.end() ? *known : AtPost{.address = address});
  }
  at_post_ = std::move(next);
}

void Exchanged::hear_at_post(const ArpPacket& packet, Instant now) {
  if (std::ranges::find(macs_, packet.sender) != macs_.end()) return;
  const auto heard = std::ranges::find(at_post_, packet.from, &AtPost::address);
  if (heard != at_post_.end()) heard->seen = now;
}

Exchanged::Due Exchanged::take_due(Instant now) {
  Due due{.at_team = at_team_.take_due(now), .at_post = {}};
  const auto taken = at_team_.taken();
  std::ranges::copy_if(due.at_team, std::back_inserter(due.at_post), [&taken](std::uint32_t address) {
    return std::ranges::find(taken, address, &Takers::Taken::address) != taken.end();
  });
  return due;
}

std::vector<Takers::Taken> Exchanged::found(Instant now) const {
  auto found = at_team_.taken();
  std::erase_if(found, [&](const Takers::Taken& each) {
    const auto at_post = std::ranges::find(at_post_, each.address, &AtPost::address);
    const bool is_there =
        at_post != at_post_.end() && at_post->seen && now < *at_post->seen + network::kTakenFor;
    return is_there || each.seen < each.since + kSure;
  });
  return found;
}

}  // namespace adit::applier
