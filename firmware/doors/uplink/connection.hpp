#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

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

}  // namespace adit::uplink
