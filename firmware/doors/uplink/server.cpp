#include "uplink/server.hpp"

#include <algorithm>

#include "uplink/connection_impl.hpp"
#include "uplink/socket.hpp"

namespace adit::uplink {

Server::Server(loop::Loop& loop) : loop_(loop), wake_(loop.timer([this] { wake(); })) {}

void Server::remove(Member& one) {
  std::erase(connections_, &one);
}

void Server::remove(Turn& turn) {
  std::erase(turns_, &turn);
}

bool Server::is_free() const {
  return !is_serial_ ||
         std::ranges::none_of(connections_, [](const Member* each) { return each->socket_.has_value(); });
}

bool Server::claim(Turn& turn, bool goes_first) {
  if (!is_serial_) return true;
  turn.is_claimed = true;
  turn.goes_first = goes_first;
  if (!is_free()) return false;
  wake_.call_at(loop_.now());  // in case it sends nothing, or another one is next
  if (next_turn() != &turn) return false;
  turn.is_claimed = false;
  turn.last = loop_.now();
  return true;
}

/// Null if none is claimed.
Server::Turn* Server::next_turn() const {
  Turn* next = nullptr;
  for (Turn* const each : turns_) {
    if (!each->is_claimed) continue;
    if (next == nullptr ||
        std::pair(!each->goes_first, each->last) < std::pair(!next->goes_first, next->last))
      next = each;
  }
  return next;
}

void Server::on_silence() {
  if (is_serial_) return;
  cleared_until_ = loop_.now() + kSilence;
  wake_.call_at(cleared_until_);
  close_idle();
}

void Server::close_idle() {
  for (Member* const each : connections_) {
    if (!each->socket_ || each->exchange_) continue;
    suspect(*each);
    each->close();
  }
}

/// The connection ends without a request. It may have blocked the silent ones.
void Server::suspect(const Member& closed) {
  if (!closed.connected() || closed.socket_->is_passed) return;
  const loop::Instant answer_by = loop_.now() + (closed.socket_->is_served ? kSilence : kAtOnce);
  for (Member* const each : connections_) {
    if (each->is_silent() && !each->wait_.answer_by) each->wait_.answer_by = answer_by;
  }
}

bool Server::on_answer(Member& one, bool can_stay) {
  const loop::Instant now = loop_.now();
  for (Member* const each : connections_) {
    if (each == &one || !each->connected() || !is_quiet(each->socket_->fd.get())) continue;
    if (each->socket_->idle_since >= one.wait_.since) continue;
    each->socket_->is_passed = true;
    helped_ = 0;
  }
  const Member::Wait wait = std::exchange(one.wait_, {});
  const bool is_helped = wait.answer_by && now <= *wait.answer_by && wait.since >= helped_at_;
  if (is_helped) helped_at_ = now;
  if (is_helped && ++helped_ == 2) begin_serial();
  if (!can_stay || is_serial_) return false;
  one.socket_->idle_since = now;
  one.socket_->is_served = true;
  one.socket_->is_passed = false;
  if (std::ranges::none_of(connections_, [](const Member* each) { return each->is_silent(); })) return true;
  suspect(one);
  return false;
}

void Server::begin_serial() {
  is_serial_ = true;
  helped_ = 0;
  try_again_at_ = loop_.now() + kTryAgain;
  close_idle();
  on_close();
}

void Server::on_close() {
  if (is_serial_) wake_.call_at(loop_.now());
}

/// Connects warm connections and lets senders send. They may destroy connections and turns.
void Server::wake() {
  const auto alive = shared_from_this();
  if (is_serial_ && loop_.now() >= try_again_at_) is_serial_ = false;
  if (is_serial_) {
    wake_.call_at(try_again_at_);
  } else {
    for (Member* const each : connections_) each->return_warm();
  }
  while (is_free()) {
    Turn* const next = next_turn();
    if (next == nullptr) return;
    next->is_claimed = false;
    next->came();
  }
}

std::shared_ptr<Server> Servers::at(const Endpoint& endpoint) {
  std::erase_if(servers_, [](const auto& each) { return each.second.expired(); });
  auto& known = servers_[{endpoint.address, endpoint.port}];
  auto server = known.lock();
  if (!server) known = server = std::make_shared<Server>(loop_);
  return server;
}

}  // namespace adit::uplink
