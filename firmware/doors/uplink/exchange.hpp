#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "icd/bearer_token.hpp"
#include "icd/chunked_bytes.hpp"
#include "loop/loop.hpp"
#include "uplink/socket.hpp"

namespace adit::uplink {

struct Request {
  std::string method;        // "GET", "POST"
  std::string target;        // "/map/update"
  std::string content_type;  // "" without a body
  icd::ChunkedBytes body;
  /// How long the peer's TCP may acknowledge no more bytes of the request, and then how long the whole answer
  /// may take. A part of an answer does not extend this time.
  std::chrono::milliseconds answer_within{10000};
  std::size_t longest_answer = kLongestAnswer;  // bytes of its body; the outcome of a longer one is InDoubt
  /// The last kHeldBack bytes of the body leave no earlier. The peer's silence does not count until then.
  loop::Instant last_byte_not_before{};
  /// The peer has not yet answered another request on another connection, and may not read this one before.
  /// Its silence does not count until Connection::on_earlier_request_ended().
  bool goes_ahead = false;

  static constexpr std::size_t kLongestAnswer = 64u << 10;
  static constexpr std::size_t kHeldBack = 1024;
};

/// When the first and the last byte of a request left, to about 10 ms, rather too late than too early. If
/// bytes were sent twice or not all were sent, `last` is the time of the answer. If bytes were sent twice, so
/// is `first`, because the first byte may be one of them.
struct SendTimes {
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
  SendTimes sent = {};
  loop::Instant began = {};  // when the first byte was given to the kernel

  /// Redirects to the other form of the path without processing the request (RFC 9110 15.4.8, 15.4.9).
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

/// Parses "Sun, 06 Nov 1994 08:49:37 GMT" (IMF-fixdate, RFC 9110 5.6.7). nullopt if `text` is no such date.
/// Does not check the name of the day.
std::optional<std::chrono::sys_seconds> http_date(const std::string& text);

/// Parses an HTTP/1 answer to one request as its bytes arrive (RFC 9112). Skips interim answers (1xx).
///
/// Memory is bounded whatever lengths the peer announces: only received bytes are held, at most
/// `longest_body` of the body, kLongestHead of each head, and kMostBytes() in all.
class AnswerParser {
 public:
  enum class State : std::uint8_t { Incomplete, Whole, Malformed };
  static constexpr std::size_t kLongestHead = 16 * 1024;  // bytes

  /// `longest_body`: bytes. A longer body is Malformed as soon as its length is known.
  explicit AnswerParser(std::size_t longest_body);
  ~AnswerParser();

  /// Requires that no earlier call returned Whole or Malformed.
  State feed(std::string_view bytes);
  /// The peer has closed its direction. This ends an answer without a length (RFC 9112 6.3).
  State feed_end();

  /// The status; 0 until the head has arrived.
  int status() const;
  /// Returns and removes the body received since the last call, for an endless answer. take_answer() does not
  /// return these bytes, and all limits start again.
  std::string take_part();

  /// For Whole, before take_answer(): the field Location, or "".
  std::string location() const;
  /// For Whole. A body with a Content-Encoding is decoded, if that takes at most `longest_body`.
  Answered take_answer();
  /// For Whole: both sides allow reuse of the connection, and no bytes followed the answer.
  bool can_keep_alive() const;
  /// For Malformed: the status if the only fault is the length; else 0.
  int too_long_status() const;
  /// For Malformed: a sentence on the fault.
  const std::string& fault() const;
  bool has_begun() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// True if an answer redirects a request to the same path with a slash at its end on the same server (RFC
/// 9110 15.4): the target "/map/update" to the location "/map/update/" or
/// "http://10.100.1.201:8000/map/update/". False if it redirects "/map/update/" to "/map/update". nullopt for
/// all other answers. `authority`: host and port of the request.
std::optional<bool> redirects_to_slash(int status, std::string_view location, std::string_view authority,
                                       std::string_view target);

/// Sends one request, parses its answer, and measures the peer's silence. The caller owns the socket.
class Exchange {
 public:
  Exchange(const Endpoint& endpoint, const icd::BearerToken& token, Request request);

  /// Writes one portion of the bytes that may leave. Returns 0 or an errno; then no more is written.
  int write(int fd);
  /// Call this right after the first write().
  void on_first_write(loop::Instant now) { first_left_ = now; }
  bool wants_to_write() const { return !write_broken_ && sent_ < may_go_; }
  /// Releases the bytes that were held back, if it is time. True if they were released now.
  bool release(loop::Instant now);

  enum class Answer : std::uint8_t { Waiting, Whole, Lost };
  /// Reads all received bytes. Call this even after write() has failed, because a peer that rejects a request
  /// early answers and closes. A 2xx is Whole only after the whole request has arrived. Until then is_early()
  /// is true: call this again after kLook, because the socket does not signal acknowledgements.
  Answer read(int fd);
  bool is_early() const { return is_early_; }
  static constexpr std::chrono::milliseconds kLook{10};
  /// True if the peer's TCP has acknowledged the whole request.
  bool has_arrived(int fd) const;
  /// For Whole.
  Answered take_answer();
  /// As in AnswerParser, for an endless answer.
  int status() const { return parser_.status(); }
  std::string take_part() { return parser_.take_part(); }
  /// When the request left. Call this after its answer, with the kernel's values read just before `now`.
  SendTimes sent_times(const Transmission& seen, loop::Instant now) const;
  bool can_keep_alive() const { return sent_ == total_ && !is_early_ && parser_.can_keep_alive(); }
  /// For Lost.
  InDoubt doubt() const { return {.why = fault_, .too_long_status = parser_.too_long_status()}; }

  /// Starts to measure the peer's silence. `sent_twice`: of the connection so far.
  void begin(loop::Instant now, std::uint64_t sent_twice);
  /// Records whether the peer's TCP has acknowledged more bytes since the last call. Received bytes do not
  /// count, because a peer that sends an endless answer slowly would hold the connection for ever. So the
  /// whole answer must arrive within answer_within of the last acknowledgement.
  void listen(int fd, loop::Instant now);
  /// By listen().
  loop::Instant silence_start() const { return heard_; }
  bool is_silent_at(loop::Instant now) const { return now >= silent_at(); }
  /// The earlier request has ended (Request::goes_ahead).
  void on_earlier_request_ended(loop::Instant now) {
    request_.goes_ahead = false;
    heard_ = now;
  }
  /// When to call listen() next.
  loop::Instant next_listening(loop::Instant now) const;
  /// The limit for the kernel, which does not know the other request.
  std::chrono::milliseconds longest_silence() const {
    return request_.answer_within * (request_.goes_ahead ? 2 : 1);
  }

  std::size_t sent_bytes() const { return sent_; }
  std::size_t total() const { return total_; }
  /// "POST /map/update to 10.100.1.201:8000: `what` (120 of 4711 bytes sent)".
  std::string sentence(const std::string& what) const;

 private:
  loop::Instant silent_at() const { return heard_ + request_.answer_within; }
  Answer on_lost(const std::string& why);
  void advance(std::size_t bytes);
  bool is_limited() const { return may_go_ < total_; }

  std::string authority_;
  Request request_;                     // its body: in chunks_
  icd::ChunkedBytes chunks_;            // of head and body; without those that are wholly sent
  std::size_t within_chunk_ = 0;        // bytes of the first one that are sent
  std::uint64_t bytes_per_second_ = 0;  // 0: not paced
  std::size_t total_ = 0;
  std::size_t may_go_ = 0;  // bytes of total_; the rest is held back
  std::size_t sent_ = 0;
  bool write_broken_ = false;
  bool is_early_ = false;  // a 2xx arrived before the whole request was acknowledged
  std::size_t acknowledged_ = 0;
  loop::Instant heard_;
  loop::Instant first_left_;
  std::uint64_t sent_twice_ = 0;  // segments that this connection had sent twice before the request
  AnswerParser parser_;
  std::string fault_;
};

}  // namespace adit::uplink
