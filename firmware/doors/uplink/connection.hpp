#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "icd/bearer_token.hpp"
#include "icd/chunked_bytes.hpp"
#include "loop/loop.hpp"

namespace adit::uplink {

/// The address of an endpoint, and the options of a connection to it.
struct Endpoint {
  std::string address;  // IPv4 or IPv6, numeric
  std::uint16_t port = 0;
  std::string interface;               // SO_BINDTODEVICE; "": not bound
  std::uint64_t bytes_per_second = 0;  // the highest rate; lower if the link delivers less; 0: not paced
  std::chrono::milliseconds connect_within{3000};
};

struct Request {
  std::string method;        // "GET", "POST"
  std::string target;        // "/map/update"
  std::string content_type;  // "" without a body
  icd::ChunkedBytes body;
  /// How long the peer's TCP may acknowledge no more bytes of the request, and then how long the whole answer
  /// may take. A part of an answer does not extend this time.
  std::chrono::milliseconds answer_within{10000};
  std::size_t longest_answer = kLongestAnswer;  // bytes of its body; the outcome of a longer one is InDoubt
  /// The last kHeldBack bytes of the body are not sent before this time. The peer's silence does not count
  /// until then.
  loop::Instant last_byte_not_before{};
  /// The peer has not yet answered another request on another connection, and may not read this one before.
  /// Its silence does not count until Connection::is_next().
  bool goes_ahead = false;

  static constexpr std::size_t kLongestAnswer = 64u << 10;
  static constexpr std::size_t kHeldBack = 1024;
};

/// When the first and the last byte of a request left, to about 10 ms, rather too late than too early. If
/// bytes were sent twice or not all were sent, `last` is the time of the answer. If bytes were sent twice, so
/// is `first`, because the first byte may be one of them.
struct Sent {
  loop::Instant first{}, last{};
};

/// A whole HTTP answer arrived, with any body. If its status is 2xx, the peer's TCP has acknowledged the
/// whole request.
struct Answered {
  int status = 0;
  std::string content_type;
  std::string body;
  std::optional<std::chrono::seconds> retry_after;    // from now, also if the field is a date
  std::optional<std::chrono::sys_seconds> date = {};  // by the peer's clock
  std::optional<bool> wants_slash = {};               // redirects_to_slash()
  Sent sent = {};
  loop::Instant began = {};  // when the first byte was given to the kernel

  /// The server redirects to the other form of the path and has not processed the request (RFC 9110 15.4.8,
  /// 15.4.9).
  bool is_unprocessed() const { return wants_slash && (status == 307 || status == 308); }
};
/// No byte of the request was given to the kernel. A retry is safe.
struct NeverSent {
  std::string why;  // "connecting to 10.100.1.200:8000: Connection refused"
};
/// Bytes may have left, and no whole answer arrived, or a 2xx arrived and the rest of the request was not
/// acknowledged. The result of the request is unknown.
struct InDoubt {
  std::string why;
  int too_long_status = 0;  // the status of an answer that was too long; else 0
};
using Outcome = std::variant<Answered, NeverSent, InDoubt>;

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
  /// A second connection to the same endpoint that shares the measurements of the link. Only one of them may
  /// have bytes to send at a time.
  std::unique_ptr<Connection> another() const;
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Connects now and after each close, so that a request finds an open connection.
  void keep_warm();
  /// Call this when the link may be back: restarts a pending attempt to connect, and skips the pause.
  void hurry();
  /// Connects if the connection is closed.
  void open();
  /// Closes the connection. Requires !busy().
  void close();
  /// Closes the connection by a reset. `done` of the request in flight is not called, and its answer is not
  /// read.
  void give_up();

  /// Sends a request. Requires !busy(). `done` is called once, from the loop and never within send(). It may
  /// send the next request and may destroy this connection. The destructor does not call it.
  void send(Request request, std::function<void(Outcome)> done);
  bool busy() const;
  /// The earlier request on the other connection has ended. From now on the peer's silence counts.
  void is_next();
  /// When the request in flight left; nullopt until the peer's TCP has acknowledged all of it.
  std::optional<Sent> has_arrived() const;
  bool connected() const;
  /// Why the last attempt to connect failed, or "".
  const std::string& trouble() const;

  /// Bytes of the present or last request, with its head, that the kernel has accepted.
  std::size_t sent_bytes() const;
  /// Bytes per second that the link delivered during the last requests, at most Endpoint::bytes_per_second; 0
  /// if it is not paced.
  std::uint64_t delivers() const;

 private:
  friend class Server;
  class Impl;
  explicit Connection(std::shared_ptr<Impl> impl);
  std::shared_ptr<Impl> impl_;
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
    std::function<void()> came;  // claim() again
    bool is_claimed = false;
    bool goes_first = false;
    loop::Instant last{};  // when it came
  };

  explicit Server(loop::Loop& loop);
  bool is_serial() const { return is_serial_; }
  /// False: a serial server has a connection.
  bool is_free() const;

  void add(Turn& turn) { turns_.push_back(&turn); }
  void remove(Turn& turn);
  /// True: send now. False: `came` will be called. `goes_first`: before turns that do not.
  bool claim(Turn& turn, bool goes_first);

 private:
  friend class Connection;
  using Member = Connection::Impl;

  void add(Member& one) { connections_.push_back(&one); }
  void remove(Member& one);

  /// True if connections may be open without a request.
  bool keeps_warm() const { return !is_serial_ && loop_.now() >= cleared_until_; }
  /// A request on a new connection has had no answer for kSilence.
  void on_silence();
  /// `can_stay`: by HTTP. Returns true if the connection stays open.
  bool on_answer(Member& one, bool can_stay);
  void on_close();

  void close_idle();
  void suspect(const Member& closed);
  void begin_serial();
  void wake();
  Turn* next_turn() const;

  loop::Loop& loop_;
  std::vector<Member*> connections_;
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
/// second one is made for a request (get_ready()). When a request ends, its connection is closed if the other
/// one is busy; otherwise the other one is closed. Such a server then reads the other connection, and its
/// silence counts only from then on (Request::goes_ahead).
class Connections {
 public:
  /// `turn_came`: as Server::Turn::came.
  Connections(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token, std::shared_ptr<Server> server,
              std::function<void()> turn_came);
  ~Connections() { server_->remove(turn_); }
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  void keep_warm() { first_.keep_warm(); }
  void hurry();

  /// Requires !busy() or is_ready(). `done`: as in Connection::send().
  void send(Request request, std::function<void(Outcome)> done);
  bool busy() const { return first_.busy() || (second_ && second_->busy()); }

  /// Connection::give_up() of the last request, if a request is in flight.
  void give_up() {
    if (busy()) latest_->give_up();
  }

  /// Opens a connection for the next request if one request is in flight. Tries once for each request.
  void get_ready();
  /// True if one request is in flight and a connection for the next one is open.
  bool is_ready() const;
  /// When the only request in flight left; nullopt until all of it has arrived.
  std::optional<Sent> has_arrived() const;

  /// The server gets one connection at a time, and no request ahead.
  bool is_serial() const { return server_->is_serial(); }
  /// Server::is_free()
  bool is_free() const { return server_->is_free(); }
  /// Server::claim(). Call before each send().
  bool claim_turn(bool goes_first) { return server_->claim(turn_, goes_first); }
  /// True also between two requests to a serial server.
  bool connected() const {
    return first_.connected() || (second_ && second_->connected()) || (is_serial() && trouble().empty());
  }
  /// As in Connection, for the connection of the last request.
  const std::string& trouble() const { return latest_->trouble(); }
  std::size_t sent_bytes() const { return latest_->sent_bytes(); }
  std::uint64_t delivers() const { return first_.delivers(); }

 private:
  const Connection* the_busy_one() const;
  Connection* other_than(const Connection& one);
  Connection& one_for_the_next();
  void ended(Connection& one);

  const std::shared_ptr<Server> server_;
  Server::Turn turn_;
  Connection first_;
  std::unique_ptr<Connection> second_;  // null until it is needed
  Connection* latest_ = &first_;        // the connection of the last request
  bool has_tried_ = false;              // get_ready() has tried since the last request
};

}  // namespace adit::uplink
