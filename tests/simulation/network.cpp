#include "simulation/network.hpp"

#include <sys/epoll.h>

#include <algorithm>
#include <cerrno>

#include "simulation/courses.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

/// Bytes of a segment on Ethernet. A thin line delivers segments one after the other and acknowledges each.
constexpr std::size_t kSegment = 1448;
constexpr std::size_t kWindow = 65536;
/// The longest time for which Linux delays the acknowledgement of a last segment (RFC 1122 4.2.3.2).
constexpr std::chrono::milliseconds kLateAck{40};

}  // namespace

Link::Link(World& world, std::uint64_t number, uplink::Endpoint endpoint, Random random)
    : view(place_at(endpoint.address), number),
      world_(world),
      number_(number),
      endpoint_(std::move(endpoint)),
      random_(random),
      typical_(random_.chance(0.8) ? random_.uniform(0.0001, 0.002) : random_.uniform(0.002, 0.15)),
      window_(random_.chance(0.7) ? kWindow : static_cast<std::size_t>(random_.uniform(1000, 8000))),
      acknowledges_late_(world.random("acknowledgements " + std::to_string(number)).chance(0.5)) {
  if (world.has_large_maps()) window_ = std::max(window_, kWindow);
}

loop::Duration Link::latency() {
  return seconds(typical_ * random_.uniform(0.8, 1.5));
}

/// The arrival time of bytes sent now. A stalled line holds them and retries ever less often (RFC 6298
/// 5.5), so they may arrive as long after the stall as it lasted.
loop::Instant Link::arrival() {
  const Stalls& stalls = world_.network().stalls();
  if (!stalls.is_on()) return world_.now() + latency();
  return stalls.ends() + seconds(random_.uniform(0, stalls.length())) + latency();
}

/// The arrival time of the last byte: in order, and limited by the line's rate.
loop::Instant Link::arrival_of(std::size_t bytes) {
  if (!is_thin_) return std::max(last_there_, arrival());
  const auto takes = seconds(static_cast<double>(bytes) / world_.network().map_rate());
  return std::max(std::max(last_there_, world_.now()) + takes, arrival());
}

void Link::connect(Host& host) {
  const auto how = host.connecting(endpoint_);
  if (!how) return;
  world_.at(arrival() + latency(), [self = shared_from_this(), error = *how, &host] {
    if (self->closed_) return;
    self->error = error;
    self->open = error == 0;
    self->reset = error != 0;
    if (self->open) self->peer_ = host.connected(self->endpoint_, *self);
  });
}

std::size_t Link::write(std::string_view bytes) {
  if (reset) return 0;
  if (bytes.starts_with("POST /map/update")) is_thin_ = world_.network().map_rate() > 0;
  std::size_t left = std::min(bytes.size(), window_ - std::min(window_, unacknowledged_));
  const std::size_t taken = left;
  unacknowledged_ += taken;
  if (taken > 0) last_left_ = world_.now();
  while (left > 0) {
    const std::size_t most = is_thin_ ? std::min(left, kSegment) : left;
    const std::size_t size = random_.chance(0.8) ? most : 1 + random_.uniform_index(most);
    last_there_ = arrival_of(size);
    if (world_.network().stalls().is_on()) held_until_ = last_there_;
    world_.at(last_there_, [self = shared_from_this(), piece = std::string(bytes.substr(taken - left, size)),
                            left_at = world_.now()] {
      if (self->lost_ || self->deaf_) return;
      self->acknowledge(piece.size(), left_at);
      if (self->peer_) self->peer_->received(piece, left_at);
    });
    left -= size;
  }
  return taken;
}

/// Smooths the round trip time as Linux does (RFC 6298 2.3).
void Link::acknowledge(std::size_t bytes, loop::Instant left_at) {
  unacknowledged_ -= bytes;
  delivered_ += bytes;
  const bool is_late = acknowledges_late_ && unacknowledged_ == 0;
  const loop::Duration took =
      world_.now() - left_at + seconds(typical_) + (is_late ? kLateAck : loop::Duration{});
  if (delivered_ == bytes) round_trip_ = least_round_trip_ = took;
  round_trip_ += (took - round_trip_) / 8;
  least_round_trip_ = std::min(least_round_trip_, took);
}

std::uint32_t Link::ready() const {
  if (!open && error == 0) return 0;
  std::uint32_t events = 0;
  if (!inbox.empty() || ended || reset) events |= EPOLLIN;
  if (ended || reset) events |= EPOLLRDHUP;
  if (reset) events |= EPOLLERR | EPOLLHUP;
  if (unacknowledged_ < window_ || reset) events |= EPOLLOUT;
  return events;
}

/// A reset discards unsent bytes and never overtakes sent ones.
void Link::close() {
  if (std::exchange(closed_, true)) return;
  if (resets_on_close && (world_.now() < held_until_ || random_.chance(0.5))) lost_ = true;
  last_there_ = std::max(last_there_, arrival());
  world_.at(last_there_, [self = shared_from_this()] {
    if (const auto peer = std::move(self->peer_)) peer->ended();
  });
}

void Link::vanish() {
  closed_ = vanished_ = true;
  lost_ = world_.now() < held_until_;
}

void Link::send(std::string bytes, loop::Duration delay) {
  answers_until_ = world_.now() + delay;
  while (!bytes.empty()) {
    const std::size_t size = random_.chance(0.7) ? bytes.size() : 1 + random_.uniform_index(bytes.size());
    last_here_ = std::max(last_here_, arrival() + delay);
    world_.at(last_here_, [self = shared_from_this(), piece = bytes.substr(0, size)] {
      if (!self->closed_ && !self->reset) self->inbox += piece;
    });
    bytes.erase(0, size);
  }
}

void Link::end(How how, loop::Duration delay) {
  last_here_ = std::max(last_here_, arrival() + delay);
  world_.at(last_here_,
            [self = shared_from_this(), how] { (how == How::End ? self->ended : self->reset) = true; });
}

Network::Network(World& world) : world_(world), stalls_(world) {
  Random random = world.random("rate of maps");
  map_rate_ = random.chance(0.25) && !world.has_large_maps() ? random.uniform(300, 1500) : 0;
}

int Network::connect(const uplink::Endpoint& endpoint) {
  const int fd = ++last_fd_;
  const auto number = static_cast<std::uint64_t>(fd - kFirst);
  const auto link =
      std::make_shared<Link>(world_, number, endpoint, world_.random("link " + std::to_string(number)));
  links_.emplace(fd, link);
  link->connect(*host_);
  return fd;
}

Link* Network::find(int fd) {
  const auto found = links_.find(fd);
  return found == links_.end() ? nullptr : found->second.get();
}

void Network::close(int fd) {
  const auto found = links_.find(fd);
  if (found == links_.end()) return;
  world_.note({.kind = Kind::Closes,
               .what = kConnection,
               .who = "",
               .request = static_cast<std::uint64_t>(fd - kFirst)});
  found->second->close();
  links_.erase(found);
}

void Network::cut() {
  for (const auto& [fd, link] : std::exchange(links_, {})) link->close();
}

void Network::vanish() {
  for (const auto& [fd, link] : std::exchange(links_, {})) {
    link->vanish();
    vanished_.push_back(link);
  }
}

std::uint64_t Network::watch(int fd, std::uint32_t events, Ready ready) {
  watched_.emplace(++last_, Watched{fd, events, std::move(ready)});
  return last_;
}

void Network::wait_for(std::uint64_t number, std::uint32_t events) {
  watched_.at(number).events = events;
}

bool Network::dispatch() {
  std::vector<std::uint64_t> numbers;
  numbers.reserve(watched_.size());
  for (const auto& [number, watched] : watched_) numbers.push_back(number);
  bool any = false;
  for (const std::uint64_t number : numbers) {
    const auto found = watched_.find(number);
    if (found == watched_.end() || found->second.events == 0) continue;
    const Link* const link = find(found->second.fd);
    if (link == nullptr) continue;
    const std::uint32_t events = link->ready() & (found->second.events | EPOLLERR | EPOLLHUP);
    if (events == 0) continue;
    any = true;
    const Ready call = found->second.ready;
    call(events);
  }
  return any;
}

}  // namespace adit::simulation
