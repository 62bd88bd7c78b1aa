#pragma once

#include <sys/epoll.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "pace/delivery.hpp"
#include "uplink/connection.hpp"
#include "uplink/exchange.hpp"

namespace adit::uplink {

/// When to connect next. The pause between two attempts doubles while they fail.
class ConnectAttempts {
 public:
  void begins(loop::Instant now) { began_ = now; }
  void succeeded() {
    trouble_.clear();
    hurry();
  }
  /// Returns the time of the next attempt.
  loop::Instant failed(std::string why) {
    trouble_ = std::move(why);
    return began_ + std::exchange(pause_, std::min(pause_ * 2, kLongestPause));
  }
  /// The link may be back: the next pause is short.
  void hurry() { pause_ = kFirstPause; }
  loop::Instant next() const { return began_ + pause_; }
  /// Why the last attempt failed, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  static constexpr std::chrono::seconds kFirstPause{1}, kLongestPause{5};

  loop::Instant began_;  // the last attempt
  std::chrono::seconds pause_ = kFirstPause;
  std::string trouble_;
};

/// Keeps the pace of a connection's socket at the rate that the link delivers.
class LinkPace {
 public:
  /// `most`: bytes per second; 0: not paced.
  explicit LinkPace(std::uint64_t most) {
    if (most > 0) delivery_.emplace(static_cast<double>(most));
  }

  /// Call this when the first bytes of a request have just been written to `fd`.
  void begins(int fd, loop::Instant now);
  /// Call this before more bytes are written, and every kLook.
  void goes_on(int fd, loop::Instant now);
  static constexpr loop::Duration kLook = pace::Delivery::kInterval / 2;

  /// Bytes per second that the link delivers, as measured; 0: not paced.
  std::uint64_t delivers() const;

 private:
  void tell(int fd);

  std::optional<pace::Delivery> delivery_;
  std::uint64_t told_ = 0;  // the pace that the socket has
};

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

  // Connecting and idling.
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
