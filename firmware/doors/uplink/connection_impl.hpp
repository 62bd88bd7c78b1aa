#pragma once

#include <sys/epoll.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "loop/file_descriptor.hpp"
#include "uplink/connect_attempts.hpp"
#include "uplink/connection.hpp"
#include "uplink/exchange.hpp"
#include "uplink/link_pace.hpp"
#include "uplink/server.hpp"

namespace adit::uplink {

/// The state of a Connection. A running callback keeps it alive, because `done` may destroy the Connection.
class Connection::Impl : public std::enable_shared_from_this<Impl> {
 public:
  Impl(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token, std::shared_ptr<Server> server,
       std::shared_ptr<LinkPace> pace);
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
  bool connected() const { return socket_ && socket_->is_open; }
  const std::string& trouble() const { return attempts_.trouble(); }
  std::size_t sent_bytes() const { return exchange_ ? exchange_->sent() : sent_; }
  std::uint64_t delivers() const { return pace_->delivers(); }

 private:
  friend class Server;

  static constexpr std::chrono::milliseconds kLookForSilence{200};
  static constexpr std::uint32_t kComing = EPOLLIN | EPOLLRDHUP;

  /// A socket that is connecting or open.
  struct Socket {
    loop::FileDescriptor fd;
    loop::Source source = {};  // of fd; destroyed before it
    bool is_open = false;
    bool is_fresh = false;         // connected for the request in flight
    std::uint64_t sent_twice = 0;  // Transmission::sent_twice while it is idle
    loop::Instant idle_since{};    // when it opened, or the last answer after which it stayed open
    bool is_served = false;        // it stayed open after an answer
    bool is_passed = false;        // the server has answered on another connection since
  };

  /// Of the request in flight.
  struct Wait {
    loop::Instant since{};
    bool is_silent = false;                       // no answer for Server::kSilence on a new connection
    std::optional<loop::Instant> answer_by = {};  // an answer until then shows that it was blocked
  };

  void call(void (Impl::*part)());

  // Callbacks of the socket and the timers.
  void ready();
  void time_came();
  void look();
  void check_silence();

  // Connecting and idling (connecting.cpp).
  void connect();
  void connecting_ended(int error);
  void connecting_failed(const std::string& why);
  void rest();
  void idle_ended();
  void drop();
  void close();
  bool stays_warm() const { return warm_ && server_->keeps_warm(); }

  // For the server.
  bool is_silent() const { return exchange_ && wait_.is_silent; }
  void return_warm();

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

  std::optional<Socket> socket_;  // none: closed
  loop::Source timer_;            // the end of a pause, connecting, idling or waiting for the peer
  bool warm_ = false;
  ConnectAttempts attempts_;

  std::unique_ptr<Exchange> exchange_;
  std::function<void(Outcome)> done_;
  bool within_send_ = false;
  std::optional<Outcome> outcome_;  // known within send(); delivered after it
  loop::Source tell_;
  std::size_t sent_ = 0;

  const std::shared_ptr<Server> server_;
  Wait wait_;
  loop::Source silence_;  // while the request may become silent

  const std::shared_ptr<LinkPace> pace_;
  loop::Source look_;  // while bytes wait to be written
};

}  // namespace adit::uplink
