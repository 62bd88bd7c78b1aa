#pragma once

#include <sys/epoll.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "loop/file_descriptor.hpp"
#include "uplink/connection.hpp"
#include "uplink/exchange.hpp"
#include "uplink/link_pace.hpp"

namespace adit::uplink {

/// The state of a Connection. A running callback keeps it alive, because `done` may destroy the Connection.
class Connection::Impl : public std::enable_shared_from_this<Impl> {
 public:
  Impl(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token, std::shared_ptr<LinkPace> pace);
  std::shared_ptr<Impl> another() const;

  void keep_warm();
  void hurry();
  void open();
  void end();
  void send(Request request, std::function<void(Outcome)> done);
  void is_next();
  std::optional<Sent> has_arrived() const;
  void give_up();
  /// The Connection is destroyed. A running callback may still hold this object.
  void abandon();

  bool busy() const { return done_ != nullptr; }
  bool connected() const { return phase_ == Phase::Open; }
  const std::string& trouble() const { return trouble_; }
  std::size_t sent_bytes() const { return exchange_ ? exchange_->sent() : sent_; }
  std::uint64_t delivers() const { return pace_->delivers(); }

 private:
  enum class Phase : std::uint8_t { Closed, Connecting, Open };
  /// The shortest pause between two attempts to keep the connection warm, and the longest while they fail.
  static constexpr std::chrono::seconds kFirstPause{1}, kLongestPause{5};
  static constexpr std::uint32_t kComing = EPOLLIN | EPOLLRDHUP;

  void call(void (Impl::*part)());

  // Callbacks of the socket and the timers.
  void ready();
  void time_came();
  void look();

  // Connecting and idling (connecting.cpp).
  void connect();
  void connect_in_time();
  void connecting_ended(int error);
  void connecting_failed(const std::string& why);
  void rest();
  void idle_ended();
  void drop();
  void close();
  void watch(std::uint32_t events);

  // A request and its answer.
  void begin_sending();
  void begin();
  void begin_again();
  void write();
  void began_to_leave();
  bool answer_came();
  void listen_again();
  void answered();
  void in_doubt(InDoubt doubt);
  void never_sent(const std::string& reason);
  void deliver(Outcome outcome);
  void tell();
  void call_done(Outcome outcome);

  loop::Loop& loop_;
  const Endpoint endpoint_;
  const icd::BearerToken token_;

  Phase phase_ = Phase::Closed;
  loop::FileDescriptor fd_;
  std::chrono::milliseconds gives_up_after_{};  // TCP_USER_TIMEOUT of fd_; 0: not set
  std::uint64_t sent_twice_ = 0;                // Transmission::sent_twice of fd_ while it is idle
  loop::Source source_;                         // of fd_; destroyed before it
  std::uint32_t watched_ = 0;
  loop::Source timer_;  // the end of a pause, connecting, idling or waiting for the peer
  bool warm_ = false;
  bool fresh_ = false;   // connected for the request in flight
  loop::Instant began_;  // the last attempt to connect
  std::chrono::seconds pause_ = kFirstPause;
  std::string trouble_;

  std::unique_ptr<Exchange> exchange_;
  std::function<void(Outcome)> done_;
  bool within_send_ = false;
  std::optional<Outcome> outcome_;  // known within send(); delivered after it
  loop::Source tell_;
  std::size_t sent_ = 0;

  const std::shared_ptr<LinkPace> pace_;
  loop::Source look_;  // while bytes wait to be written
};

}  // namespace adit::uplink
