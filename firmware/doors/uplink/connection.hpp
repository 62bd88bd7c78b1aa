#pragma once

#include <sys/epoll.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "icd/bearer_token.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "pace/delivery.hpp"
#include "uplink/exchange.hpp"
#include "uplink/socket.hpp"

namespace adit::uplink {

/// When to connect next. The pause between two attempts doubles while they fail.
class ConnectAttempts {
 public:
  void on_begun(loop::Instant now) { began_ = now; }
  void on_succeeded() {
    trouble_.clear();
    retry_now();
  }
  /// Returns the time of the next attempt.
  loop::Instant on_failed(std::string why) {
    trouble_ = std::move(why);
    return began_ + std::exchange(pause_, std::min(pause_ * 2, kLongestPause));
  }
  /// The link may be back: the next pause is short.
  void retry_now() { pause_ = kFirstPause; }
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
  void on_write_begun(int fd, loop::Instant now);
  /// Call this before more bytes are written, and every kLook.
  void on_write(int fd, loop::Instant now);
  static constexpr loop::Duration kLook = pace::Delivery::kInterval / 2;

  /// Bytes per second that the link delivers, as measured; 0: not paced.
  std::uint64_t delivery_rate() const;

 private:
  void apply_pace(int fd);

  std::optional<pace::Delivery> delivery_;
  std::uint64_t told_ = 0;  // the pace that the socket has
};

class Server;

/// One HTTP/1.1 connection (RFC 9112) to the Command Post. It sends one request at a time and stays open
/// between requests.
///
/// It connects before a request needs it (keep_warm(), not to a serial server), closes an idle connection
/// before the Command Post does, and never sends `Expect`. It drops the connection after an answer of 400 or
/// more, because the measured server promises keep-alive and closes; after an answer that says close; after
/// any fault; and after each answer of a serial server.
class Connection {
 public:
  static constexpr std::chrono::seconds kIdle{25};  // a server closes after 60

  /// `server`: at this endpoint; null: other connections to it are unknown.
  Connection(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token,
             std::shared_ptr<Server> server = nullptr);
  /// A second connection to this endpoint with the same measurements. Only one at a time may send bytes.
  std::unique_ptr<Connection> another() const;
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Connects now and after each close, so that a request finds an open connection.
  void keep_warm();
  /// Call this when the link may be back: restarts a pending attempt to connect, and skips the pause.
  void retry_now();
  /// Connects if the connection is closed.
  void open() {
    if (!socket_) connect();
  }
  /// Closes the connection. Requires !busy().
  void close();
  /// Closes the connection by a reset. The `done` in flight is not called, and its answer is not read.
  void give_up();

  /// Sends a request. Requires !busy(). `done` is called once, from the loop and never within send(). It may
  /// send the next request and may destroy this connection. The destructor does not call it.
  void send(Request request, std::function<void(Outcome)> done);
  bool busy() const { return done_ != nullptr; }
  /// The earlier request on the other connection has ended. From now on the peer's silence counts.
  void on_earlier_request_ended();
  /// When the request in flight left; nullopt until the peer's TCP has acknowledged all of it.
  std::optional<SendTimes> has_arrived() const;
  bool is_connected() const { return socket_ && socket_->is_open; }
  /// Why the last attempt to connect failed, or "".
  const std::string& trouble() const { return attempts_.trouble(); }

  /// Bytes of the present or last request, with its head, that the kernel has accepted.
  std::size_t sent_bytes() const { return exchange_ ? exchange_->sent_bytes() : sent_; }
  /// Bytes per second that the link delivered lately, at most Endpoint::bytes_per_second; 0: not paced.
  std::uint64_t delivers() const { return pace_->delivery_rate(); }

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

  Connection(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token, std::shared_ptr<Server> server,
             std::shared_ptr<LinkPace> pace);

  // `done` may destroy this object. So a function that may call it does so last.

  // Callbacks of the socket and the timers.
  void on_socket_ready();
  void on_timer();
  void update_pace();
  void check_silence();

  // Connecting and idling.
  void connect();
  void on_connect_result(int error);
  void on_connect_failed(const std::string& why);
  void rest();
  void on_idle_ended();
  void drop();
  void close_socket();
  bool keeps_idle() const;

  // For the server.
  bool is_silent() const { return exchange_ && wait_.is_silent; }
  void return_warm();

  // A request and its answer.
  void begin_sending();
  void begin();
  void retry_request();
  void write();
  void on_first_write();
  bool read_answer();
  void schedule_listening() { timer_.call_at(exchange_->next_listening(loop_.now())); }
  void on_answered();
  void on_in_doubt(InDoubt doubt);
  void deliver_never_sent(const std::string& reason);
  void deliver(Outcome outcome);
  void report_outcome();
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

/// The server at one address and port, and the connections to it. A serial server serves one connection at a
/// time: until that one is closed, it reads no other, although the kernel accepts them.
///
/// If a request on a new connection gets no answer for kSilence, the idle connections are closed. If it is
/// answered within kSilence after that, an idle connection may have blocked it; within kAtOnce if that
/// connection never had an answer, because a server that closes each connection is read only once. The second
/// such answer in a row shows a serial server. A server that answers one connection while an older one stays
/// open is not serial, so the count begins again.
///
/// A serial server gets one connection at a time, for one request. A sender composes its request when its
/// turn comes: a report first, otherwise the sender that was served longest ago. A slow server may look like
/// a serial one, so several connections are tried again every kTryAgain.
class Server : public std::enable_shared_from_this<Server> {
 public:
  static constexpr std::chrono::seconds kSilence{1};
  static constexpr std::chrono::milliseconds kAtOnce{200};
  static constexpr std::chrono::minutes kTryAgain{5};

  /// Of a sender.
  struct Turn {
    std::function<void()> on_turn;  // claim() again
    bool is_claimed = false;
    bool goes_first = false;
    loop::Instant last{};  // when it came
  };

  explicit Server(loop::Loop& loop);
  bool is_serial() const { return is_serial_; }
  /// False: a serial server has a connection.
  bool is_free() const;

  void add(Turn& turn) { turns_.push_back(&turn); }
  void remove(Turn& turn) { std::erase(turns_, &turn); }
  /// True: send now. False: `on_turn` will be called. `goes_first`: before turns that do not.
  bool claim(Turn& turn, bool goes_first);

 private:
  friend class Connection;

  void add(Connection& one) { connections_.push_back(&one); }
  void remove(Connection& one) { std::erase(connections_, &one); }

  /// True if connections may be open without a request.
  bool can_keep_idle() const { return !is_serial_ && loop_.now() >= cleared_until_; }
  /// A request on a new connection has had no answer for kSilence.
  void on_silence();
  /// `can_stay`: by HTTP. Returns true if the connection stays open.
  bool on_answer(Connection& one, bool can_stay);
  void on_close() {
    if (is_serial_) wake_.call_at(loop_.now());
  }

  void close_idle();
  void suspect(const Connection& closed);
  void begin_serial();
  void wake();
  Turn* next_turn() const;

  loop::Loop& loop_;
  std::vector<Connection*> connections_;
  std::vector<Turn*> turns_;
  bool is_serial_ = false;
  int helped_ = 0;             // requests in a row that were answered after idle connections were closed
  loop::Instant helped_at_{};  // when the last one was answered
  loop::Instant cleared_until_{}, try_again_at_{};
  loop::Source wake_;
};

/// Each server that has connections.
class Servers {
 public:
  explicit Servers(loop::Loop& loop) : loop_(loop) {}
  std::shared_ptr<Server> at(const Endpoint& endpoint);

 private:
  loop::Loop& loop_;
  std::map<std::pair<std::string, std::uint16_t>, std::weak_ptr<Server>> servers_;
};

/// A connection to the Command Post, and sometimes a second one. A request on the second one goes ahead: it
/// is sent when the earlier request has arrived, and before its answer.
///
/// Some servers serve one connection at a time, so there are two connections no longer than necessary. The
/// second one is made for a request (preconnect()). When a request ends, its connection is closed if the
/// other one is busy; otherwise the other one is closed. Such a server then reads the other connection, and
/// its silence counts only from then on (Request::goes_ahead).
class Connections {
 public:
  /// `turn_came`: as Server::Turn::on_turn.
  Connections(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token, std::shared_ptr<Server> server,
              std::function<void()> turn_came);
  ~Connections() { server_->remove(turn_); }
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  void keep_warm() { first_.keep_warm(); }
  void retry_now();

  /// Requires !busy() or is_ready(). `done`: as in Connection::send().
  void send(Request request, std::function<void(Outcome)> done);
  bool busy() const { return first_.busy() || (second_ && second_->busy()); }

  void give_up() {
    if (busy()) latest_->give_up();
  }

  /// Opens a connection for the next request if one request is in flight. Tries once for each request.
  void preconnect();
  /// True if one request is in flight and a connection for the next one is open.
  bool is_ready() const;
  /// When the only request in flight left; nullopt until all of it has arrived.
  std::optional<SendTimes> has_arrived() const;

  /// The server gets one connection at a time, and no request ahead.
  bool is_serial() const { return server_->is_serial(); }
  bool is_free() const { return server_->is_free(); }
  /// Server::claim(). Call before each send().
  bool claim_turn(bool goes_first) { return server_->claim(turn_, goes_first); }
  /// True also between two requests to a serial server.
  bool is_connected() const {
    return first_.is_connected() || (second_ && second_->is_connected()) ||
           (is_serial() && trouble().empty());
  }
  /// As in Connection, for the connection of the last request.
  const std::string& trouble() const { return latest_->trouble(); }
  std::size_t sent_bytes() const { return latest_->sent_bytes(); }
  std::uint64_t delivers() const { return first_.delivers(); }

 private:
  const Connection* busy_connection() const;
  Connection* peer_of(const Connection& one) { return &one == &first_ ? second_.get() : &first_; }
  Connection& select_connection();
  void on_ended(Connection& one);

  const std::shared_ptr<Server> server_;
  Server::Turn turn_;
  Connection first_;
  std::unique_ptr<Connection> second_;  // null until it is needed
  Connection* latest_ = &first_;        // the connection of the last request
  bool has_tried_ = false;              // preconnect() has tried since the last request
};

}  // namespace adit::uplink
