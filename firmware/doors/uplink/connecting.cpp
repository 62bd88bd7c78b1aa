// Connecting, idling and closing.
#include <algorithm>
#include <cstring>
#include <utility>

#include "uplink/connection_impl.hpp"
#include "uplink/socket.hpp"

namespace adit::uplink {

void Connection::Impl::keep_warm() {
  warm_ = true;
  if (phase_ == Phase::Closed) connect_in_time();
}

void Connection::Impl::hurry() {
  const auto alive = shared_from_this();
  pause_ = kFirstPause;
  if (phase_ == Phase::Connecting) {
    close();
    connect();
  } else if (phase_ == Phase::Closed && warm_) {
    connect();
  }
}

void Connection::Impl::open() {
  if (phase_ == Phase::Closed) connect();
}

/// As drop(), if the connection is not closed.
void Connection::Impl::end() {
  if (phase_ != Phase::Closed) drop();
}

void Connection::Impl::connect() {
  began_ = loop_.now();
  auto fd = begin_connect(endpoint_);
  if (!fd) return connecting_failed(fd.error().why);
  fd_ = std::move(*fd);
  gives_up_after_ = {};
  phase_ = Phase::Connecting;
  watched_ = EPOLLOUT;
  timer_.call_at(began_ + endpoint_.connect_within);
  source_ = loop_.watch(fd_.get(), watched_, [this](std::uint32_t) { call(&Impl::ready); });
}

/// Connects now, or when the pause since the last attempt is over.
void Connection::Impl::connect_in_time() {
  const loop::Instant when = began_ + pause_;
  if (when <= loop_.now()) return connect();
  timer_.call_at(when);
}

void Connection::Impl::connecting_ended(int error) {
  if (error != 0) return connecting_failed(std::strerror(error));
  phase_ = Phase::Open;
  sent_twice_ = transmission(fd_.get()).sent_twice;
  trouble_.clear();
  pause_ = kFirstPause;
  fresh_ = exchange_ != nullptr;
  if (exchange_) return begin();
  rest();
}

void Connection::Impl::connecting_failed(const std::string& why) {
  trouble_ = "connecting to " + authority_of(endpoint_) +
             (endpoint_.interface.empty() ? "" : " by " + endpoint_.interface) + ": " + why;
  close();
  const auto pause = std::exchange(pause_, std::min<std::chrono::seconds>(pause_ * 2, kLongestPause));
  if (warm_) timer_.call_at(began_ + pause);
  if (exchange_) deliver(NeverSent{trouble_});
}

/// Waits for the next request, and closes an idle connection before the peer does.
void Connection::Impl::rest() {
  watch(kComing);
  timer_.call_at(loop_.now() + kIdle);
}

/// The connection was idle for kIdle, the peer closed it, or the peer sent bytes without a request. Closes it
/// before it connects again, because some servers serve one connection at a time.
void Connection::Impl::idle_ended() {
  close();
  if (warm_) connect_in_time();
}

void Connection::Impl::drop() {
  close();
  if (warm_) timer_.call_at(std::max(loop_.now(), began_ + pause_));
}

void Connection::Impl::close() {
  source_ = {};
  fd_ = {};
  phase_ = Phase::Closed;
  if (timer_) timer_.cancel();
}

void Connection::Impl::watch(std::uint32_t events) {
  if (std::exchange(watched_, events) != events) source_.wait_for(events);
}

}  // namespace adit::uplink
