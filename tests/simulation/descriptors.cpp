#include "simulation/descriptors.hpp"

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>

namespace adit::simulation {

Descriptors::Descriptors() : epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
  if (epoll_ < 0) std::abort();
}

Descriptors::~Descriptors() {
  ::close(epoll_);
}

std::uint64_t Descriptors::add(int fd, std::uint32_t events, Ready ready, Whose whose) {
  watched_.emplace(++last_, Watched{fd, whose, false, std::move(ready)});
  wait_for(last_, events);
  return last_;
}

void Descriptors::wait_for(std::uint64_t number, std::uint32_t events) {
  Watched& watched = watched_.at(number);
  epoll_event event{.events = events, .data = {.u64 = number}};
  if (events == 0) {
    if (watched.added) ::epoll_ctl(epoll_, EPOLL_CTL_DEL, watched.fd, nullptr);
    watched.added = false;
    return;
  }
  if (::epoll_ctl(epoll_, watched.added ? EPOLL_CTL_MOD : EPOLL_CTL_ADD, watched.fd, &event) != 0)
    std::abort();
  watched.added = true;
}

void Descriptors::remove(std::uint64_t number) {
  const auto found = watched_.find(number);
  if (found == watched_.end()) return;
  if (found->second.added) ::epoll_ctl(epoll_, EPOLL_CTL_DEL, found->second.fd, nullptr);
  watched_.erase(found);
}

bool Descriptors::dispatch(Whose whose) {
  std::array<epoll_event, 256> events;  // NOLINT(cppcoreguidelines-pro-type-member-init): asked for so often
  const int count = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), 0);
  if (count <= 0) return false;
  const auto ready = std::span(events).first(static_cast<std::size_t>(count));
  std::ranges::sort(ready, {}, [](const epoll_event& event) { return event.data.u64; });
  bool any = false;
  for (const epoll_event& event : ready) {
    const auto found = watched_.find(event.data.u64);
    if (found == watched_.end() || (whose != Whose::All && found->second.whose != whose)) continue;
    any = true;
    const Ready call = found->second.ready;  // it may remove itself
    call(event.events);
  }
  return any;
}

}  // namespace adit::simulation
