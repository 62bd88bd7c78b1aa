#include "applier/conflict_detector.hpp"

#include <sys/epoll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "host/log.hpp"
#include "host/root_program.hpp"
#include "network/messages.hpp"

namespace adit::applier {
namespace {

constexpr std::size_t kFirstAsks = ConflictDetector::kFirstGaps.size() + 1;

}  // namespace

void ConflictDetector::set_own(const std::vector<std::uint32_t>& addresses, std::vector<Mac> macs,
                               Instant now) {
  macs_ = std::move(macs);
  std::vector<WatchedAddress> next;
  for (const std::uint32_t address : addresses) {
    if (next.size() == kMost) break;
    const auto known = std::ranges::find(own_, address, &WatchedAddress::address);
    next.push_back(known != own_.end()
                       ? *known
                       : WatchedAddress{.address = address, .first_asks = kFirstAsks, .ask_at = now});
  }
  own_ = std::move(next);
}

void ConflictDetector::restart_probing(Instant now) {
  for (WatchedAddress& own : own_) {
    own.first_asks = kFirstAsks;
    own.ask_at = now;
  }
}

void ConflictDetector::on_packet(const ArpPacket& packet, Instant now) {
  if (std::ranges::find(macs_, packet.sender) != macs_.end()) return;
  for (WatchedAddress& own : own_) {
    if (packet.from == own.address) {
      note(own, packet.sender, now);
    } else if (packet.probes(own.address)) {
      schedule_probe(own, now);  // if another machine has the address in spite of our kernel's answer, it
                                 // answers a request
    }
  }
}

/// Of several machines, reports the first until it falls silent.
void ConflictDetector::note(WatchedAddress& own, const Mac& by, Instant now) {
  if (!own.taken || now >= own.by_seen + network::kTakenFor)
    own.taken = Conflict{.address = own.address, .by = by, .since = now};
  own.taken->seen = now;
  if (own.taken->by == by) own.by_seen = now;
  schedule_probe(own, now);
}

void ConflictDetector::schedule_probe(WatchedAddress& own, Instant now) {
  const Instant soon = own.asked_at ? std::max(now, *own.asked_at + kBetween) : now;
  own.ask_at = own.ask_at ? std::min(*own.ask_at, soon) : soon;
}

std::vector<std::uint32_t> ConflictDetector::pop_due(Instant now) {
  std::vector<std::uint32_t> due;
  for (WatchedAddress& own : own_) {
    if (own.taken && now >= own.taken->seen + network::kTakenFor) own.taken.reset();
    if (!own.ask_at || now < *own.ask_at) continue;
    due.push_back(own.address);
    own.asked_at = now;
    own.ask_at.reset();
    if (own.first_asks > 0) --own.first_asks;
    if (own.first_asks > 0) own.ask_at = now + kFirstGaps[kFirstGaps.size() - own.first_asks];
    if (own.taken) schedule_probe(own, now);
  }
  return due;
}

std::optional<ConflictDetector::Instant> ConflictDetector::wake() const {
  std::optional<Instant> first;
  const auto at = [&first](Instant when) { first = first ? std::min(*first, when) : when; };
  for (const WatchedAddress& own : own_) {
    if (own.ask_at) at(*own.ask_at);
    if (own.taken) at(own.taken->seen + network::kTakenFor);
  }
  return first;
}

std::vector<ConflictDetector::Conflict> ConflictDetector::conflicts() const {
  std::vector<Conflict> all;
  for (const WatchedAddress& own : own_) {
    if (own.taken) all.push_back(*own.taken);
  }
  return all;
}

std::vector<std::uint32_t> sought_in(const network::Status& status, const std::vector<settings::Subnet>& own,
                                     const std::vector<settings::Subnet>& team) {
  const network::Numbers numbers = status.kept.value_or(network::Numbers{.command_post = own});
  std::vector<std::uint32_t> all;
  for (const std::uint32_t endpoint : status.endpoints.addresses) {
    const auto hop = network::next_hop(numbers, endpoint);
    const auto has = [hop](const settings::Subnet& each) { return each.contains(*hop); };
    if (hop && std::ranges::none_of(team, has)) all.push_back(*hop);
  }
  std::ranges::sort(all);
  const auto twice = std::ranges::unique(all);
  all.erase(twice.begin(), twice.end());
  all.resize(std::min(all.size(), ConflictDetector::kMost));
  return all;
}

StatusReader::StatusReader(loop::Loop& loop, std::string folder, std::function<void()> changed)
    : loop_(loop), folder_(std::move(folder)), changed_(std::move(changed)), due_(loop.timer([this] {
        watch_folder();
        changed_();
      })) {
  watch_folder();
}

void StatusReader::watch_folder() {
  noticed_ = {};  // before its descriptor is closed
  notices_ = loop::FileDescriptor(inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (!notices_ || inotify_add_watch(notices_.get(), folder_.c_str(), IN_MOVED_TO) < 0)
    return due_.call_at(loop_.now() + kLookAgain);
  noticed_ = loop_.watch(notices_.get(), EPOLLIN, [this](std::uint32_t) {
    char events[4096];
    while (::read(notices_.get(), events, sizeof events) > 0) {
    }
    changed_();
  });
}

const network::Status& StatusReader::read() {
  auto read = host::read_row<network::Status>(folder_ + '/' + host::kStatusFile);
  const std::string trouble = read ? "" : read.error();
  if (std::exchange(trouble_, trouble) != trouble && !trouble.empty())
    host::log(host::Level::Error, "cannot read the Command Post's endpoints: using the last ones",
              {{"why", trouble}});
  if (read) {
    status_ = (*std::move(read)).value_or(network::Status{});
  } else {
    due_.call_at(loop_.now() + kLookAgain);
  }
  return status_;
}

void SwappedCables::set_sought(const std::vector<std::uint32_t>& addresses, const std::vector<Mac>& macs,
                               Instant now) {
  at_team_.set_own(addresses, macs, now);
  macs_ = macs;
  std::vector<Sighting> next;
  for (const std::uint32_t address : addresses) {
    const auto known = std::ranges::find(at_post_, address, &Sighting::address);
    next.push_back(known != at_post_.end() ? *known : Sighting{.address = address});
  }
  at_post_ = std::move(next);
}

void SwappedCables::on_command_post_packet(const ArpPacket& packet, Instant now) {
  if (std::ranges::find(macs_, packet.sender) != macs_.end()) return;
  const auto heard = std::ranges::find(at_post_, packet.from, &Sighting::address);
  if (heard != at_post_.end()) heard->seen = now;
}

SwappedCables::DueProbes SwappedCables::pop_due(Instant now) {
  DueProbes due{.at_team = at_team_.pop_due(now), .at_post = {}};
  const auto taken = at_team_.conflicts();
  std::ranges::copy_if(due.at_team, std::back_inserter(due.at_post), [&taken](std::uint32_t address) {
    return std::ranges::find(taken, address, &ConflictDetector::Conflict::address) != taken.end();
  });
  return due;
}

std::vector<ConflictDetector::Conflict> SwappedCables::conflicts(Instant now) const {
  auto found = at_team_.conflicts();
  std::erase_if(found, [&](const ConflictDetector::Conflict& each) {
    const auto at_post = std::ranges::find(at_post_, each.address, &Sighting::address);
    const bool is_there =
        at_post != at_post_.end() && at_post->seen && now < *at_post->seen + network::kTakenFor;
    return is_there || each.seen < each.since + kSure;
  });
  return found;
}

}  // namespace adit::applier
