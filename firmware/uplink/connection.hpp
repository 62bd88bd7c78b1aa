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

/// Where a connection goes and how.
struct Endpoint {
  std::string address;  // IPv4 or IPv6, numeric
  std::uint16_t port = 0;
  std::string interface;               // SO_BINDTODEVICE; "": not bound
  std::uint64_t bytes_per_second = 0;  // at the most, less where the link delivers less; 0: not paced
  std::chrono::milliseconds connect_within{3000};
};

struct Request {
  std::string method;        // "GET", "POST"
  std::string target;        // "/map/update"
  std::string content_type;  // "" without a body
  icd::ChunkedBytes body;
  /// How long the peer's TCP may acknowledge no more of the request, and then how long the whole answer may
  /// take. Halves of an answer do not make it longer.
  std::chrono::milliseconds answer_within{10000};
  std::size_t longest_answer = kLongestAnswer;  // bytes of its body; a longer one is InDoubt
  /// The last kHeldBack bytes of the body wait until then; the peer's silence does not count meanwhile.
  loop::Instant last_byte_not_before{};
  /// The peer has still to answer another request, on another connection, and may read no more before it has:
  /// its silence does not count until Connection::is_next().
  bool goes_ahead = false;

  static constexpr std::size_t kLongestAnswer = 64u << 10;
  static constexpr std::size_t kHeldBack = 1024;
};

/// When the bytes of a request left: the first and the last, to some 10 ms, in doubt the later. If some were
/// sent twice, or not all were sent, the last is as late as the answer; if some were sent twice, the first
/// too: it may be one of these.
struct Sent {
  loop::Instant first{}, last{};
};

/// A whole HTTP answer came. Its body may be anything. If it is a 2xx, the peer's TCP has acknowledged the
/// whole request.
struct Answered {
  int status = 0;
  std::string content_type;
  std::string body;
  std::optional<std::chrono::seconds> retry_after;
  std::optional<std::chrono::sys_seconds> date = {};  // by the peer's clock
  bool wants_slash = false;                           // redirects_to_slash()
  Sent sent = {};
};
/// No byte of the request was given to the kernel: it is safe to send it again.
struct NeverSent {
  std::string why;  // "connecting to 10.100.1.200:8000: Connection refused"
};
/// Bytes may have left and no whole answer came, or a 2xx came and the rest of the request never arrived:
/// nobody here knows what became of it.
struct InDoubt {
  std::string why;
  int too_long_status = 0;  // of an answer that came and was longer than a Command Post's; else 0
};
using Outcome = std::variant<Answered, NeverSent, InDoubt>;

/// One HTTP/1.1 connection (RFC 9112) to the Command Post, one request at a time, kept alive between
/// requests.
///
/// It connects ahead of need (keep_warm()), gives up an idle connection before the Command Post does, drops
/// the connection after any answer of 400 or more (the measured server promises keep-alive and closes), after
/// an answer that says close and after anything odd, and never sends `Expect`.
class Connection {
 public:
  static constexpr std::chrono::seconds kIdle{25};  // a server closes after 60

  Connection(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token);
  /// One more to the same place, that shares what is known of the link: only one of them is to have bytes to
  /// send at a time.
  std::unique_ptr<Connection> another() const;
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Connects now and again after each close, so that a request finds the connection open.
  void keep_warm();
  /// The way there may be back: what is being connected begins again, and no pause is waited for.
  void hurry();
  /// Connects, if it is closed.
  void open();
  /// Closes it. Requires !busy().
  void close();
  /// Closes it, by a reset. `done` of the request under way is never called, and its answer is never read.
  void give_up();

  /// Requires !busy(). `done` is called once, from the loop, never from within send(); it may send the next
  /// request and may destroy this connection. Destroyed while busy, the connection never calls it.
  void send(Request request, std::function<void(Outcome)> done);
  bool busy() const;
  /// No request goes ahead of the one that is under way any more: from now on the peer's silence counts.
  void is_next();
  /// When the request under way left, once the peer's TCP has acknowledged all of it.
  std::optional<Sent> has_arrived() const;
  bool connected() const;
  /// Why the last connecting failed, or "".
  const std::string& trouble() const;

  /// Bytes of the request under way, or of the last one, that the kernel has taken so far, head included.
  std::size_t sent_bytes() const;
  /// Bytes a second that the link takes, as its last requests showed, at most Endpoint::bytes_per_second; 0
  /// where it is not paced.
  std::uint64_t delivers() const;

 private:
  class Impl;
  explicit Connection(std::shared_ptr<Impl> impl);
  std::shared_ptr<Impl> impl_;
};

}  // namespace adit::uplink
