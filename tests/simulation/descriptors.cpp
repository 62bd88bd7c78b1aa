#include "simulation/descriptors.hpp"

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <utility>

namespace adit::simulation {

Descriptors::Descriptors() : epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
  if (epoll_ < 0) std::abort();
}

Descriptors::~Descriptors() {
  ::close(epoll_);
}

std::uint64_t Descriptors::add(int fd, std::uint32_t events, Ready ready, Whose whose) {
  watched_.emplace(++last_, Watched{.fd = fd,
                                    .whose = whose,
                                    .edge = (events & EPOLLET) != 0,
                                    .added = false,
                                    .ready = std::move(ready)});
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
  std::array<epoll_event, 256>
      events;  // NOLINT(cppcoreguidelines-pro-type-member-init): called too often to clear it
  const int count = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), 0);
  for (const epoll_event& event : std::span(events).first(static_cast<std::size_t>(std::max(count, 0)))) {
    const std::uint64_t number = event.data.u64;  // copied, because the kernel's struct is packed
    happened_[number] |= event.events;
  }
  bool any = false;
  for (const auto& [number, what] : std::exchange(happened_, {})) {
    const auto found = watched_.find(number);
    if (found == watched_.end()) continue;
    if (whose != Whose::All && found->second.whose != whose) {
      if (found->second.edge) happened_[number] |= what;  // an edge is reported once
      continue;
    }
    any = true;
    const Ready call = found->second.ready;  // copied, because it may remove itself
    call(what);
  }
  return any;
}

}  // namespace adit::simulation
