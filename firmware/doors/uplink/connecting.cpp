// Connecting, idling and closing.
#include <algorithm>
#include <cstring>
#include <utility>

#include "uplink/connection_impl.hpp"
#include "uplink/socket.hpp"

namespace adit::uplink {

void Connection::Impl::keep_warm() {
  warm_ = true;
  return_warm();
}

void Connection::Impl::hurry() {
  const auto alive = shared_from_this();
  attempts_.hurry();
  if (connected() || (!socket_ && !stays_warm())) return;
  close();
  connect();
}

void Connection::Impl::open() {
  if (!socket_) connect();
}

/// As drop(), if the connection is not closed.
void Connection::Impl::end() {
  if (socket_) drop();
}

void Connection::Impl::connect() {
  attempts_.begins(loop_.now());
  auto fd = begin_connect(endpoint_);
  if (!fd) return connecting_failed(fd.error().why);
  timer_.call_at(loop_.now() + endpoint_.connect_within);
  socket_.emplace(std::move(*fd));
  socket_->source = loop_.watch(socket_->fd.get(), EPOLLOUT, [this](std::uint32_t) { call(&Impl::ready); });
}

/// Connects an idle connection now, or when the pause since the last attempt is over.
void Connection::Impl::return_warm() {
  if (!stays_warm() || socket_ || exchange_) return;
  if (attempts_.next() <= loop_.now()) return connect();
  timer_.call_at(attempts_.next());
}

void Connection::Impl::connecting_ended(int error) {
  if (error != 0) return connecting_failed(std::strerror(error));
  socket_->is_open = true;
  socket_->idle_since = loop_.now();
  socket_->is_fresh = exchange_ != nullptr;
  socket_->sent_twice = transmission(socket_->fd.get()).sent_twice;
  attempts_.succeeded();
  if (exchange_) return begin();
  rest();
}

void Connection::Impl::connecting_failed(const std::string& why) {
  const loop::Instant next =
      attempts_.failed("connecting to " + authority_of(endpoint_) +
                       (endpoint_.interface.empty() ? "" : " by " + endpoint_.interface) + ": " + why);
  close();
  if (stays_warm()) timer_.call_at(next);
  if (exchange_) deliver(NeverSent{trouble()});
}

/// Waits for the next request, and closes an idle connection before the peer does.
void Connection::Impl::rest() {
  socket_->source.wait_for(kComing);
  timer_.call_at(loop_.now() + kIdle);
}

/// The connection was idle for kIdle, the peer closed it, or the peer sent bytes without a request. Closes it
/// before it connects again, because some servers serve one connection at a time.
void Connection::Impl::idle_ended() {
  close();
  return_warm();
}

void Connection::Impl::drop() {
  close();
  if (stays_warm()) timer_.call_at(std::max(loop_.now(), attempts_.next()));
}

void Connection::Impl::close() {
  socket_.reset();
  if (timer_) timer_.cancel();
  server_->on_close();
}

}  // namespace adit::uplink
