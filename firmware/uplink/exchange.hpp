#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "loop/loop.hpp"
#include "uplink/answer_parser.hpp"
#include "uplink/connection.hpp"
#include "uplink/socket.hpp"

namespace adit::uplink {

/// One request on its way, its answer, and how long the peer has been silent. The socket is the caller's.
class Exchange {
 public:
  Exchange(const Endpoint& endpoint, const icd::BearerToken& token, Request request);

  /// Gives the kernel one portion of what may go, as much as it takes; 0 or an errno. A failure ends the
  /// writing for good.
  int write(int fd);
  /// To be told right after the first write().
  void began_to_leave(loop::Instant now) { first_left_ = now; }
  bool wants_to_write() const { return !write_broken_ && sent_ < may_go_; }
  /// What was held back may go from now on: true where that is news.
  bool release(loop::Instant now);

  enum class Answer : std::uint8_t { Waiting, Whole, Lost };
  /// Reads all that has come, also where writing has failed: a peer that refuses a request early answers and
  /// closes, and its answer is there to be read. A 2xx counts once the whole request has arrived. Until then
  /// it is_early(): call this again after kLook, because the socket does not signal acknowledgements.
  Answer read(int fd);
  bool is_early() const { return is_early_; }
  static constexpr std::chrono::milliseconds kLook{10};
  /// The peer's TCP has acknowledged the whole request.
  bool has_arrived(int fd) const;
  /// For Whole.
  Answered take_answer();
  /// Of an answer that goes on, as AnswerParser has it.
  int status() const { return parser_.status(); }
  std::string take_part() { return parser_.take_part(); }
  /// When the request left, as the kernel says a moment before `now`, once its answer has come.
  Sent left(const Transmission& seen, loop::Instant now) const;
  bool may_keep_alive() const { return sent_ == total_ && !is_early_ && parser_.may_keep_alive(); }
  /// For Lost.
  InDoubt doubt() const { return {.why = fault_, .too_long_status = parser_.too_long_status()}; }

  /// The clock of the peer's silence starts.
  void begin(int fd, loop::Instant now);
  /// The peer's TCP has acknowledged more bytes since the last call, or it has been silent until `now`. Bytes
  /// that come in do not count: a peer that dribbles an answer for ever would hold the connection for ever,
  /// so that the whole answer must come within answer_within of the last acknowledgement.
  void listen(int fd, loop::Instant now);
  bool is_silent_at(loop::Instant now) const { return now >= silent_at(); }
  /// It goes ahead of no other any more (Request::goes_ahead).
  void is_next(loop::Instant now) {
    request_.goes_ahead = false;
    heard_ = now;
  }
  /// When to listen next.
  loop::Instant next_listening(loop::Instant now) const;
  /// For the kernel, which knows of no other request.
  std::chrono::milliseconds longest_silence() const {
    return request_.answer_within * (request_.goes_ahead ? 2 : 1);
  }

  std::size_t sent() const { return sent_; }
  std::size_t total() const { return total_; }
  /// "POST /map/update to 10.100.1.201:8000: `what` (120 of 4711 bytes sent)".
  std::string sentence(const std::string& what) const;

 private:
  loop::Instant silent_at() const { return heard_ + request_.answer_within; }
  Answer lost(const std::string& why);
  void advance(std::size_t bytes);
  bool holds_back() const { return may_go_ < total_; }

  std::string authority_;
  Request request_;
  std::string head_;
  bool paced_ = false;
  std::size_t total_ = 0;
  std::size_t may_go_ = 0;  // of total_; the rest is held back
  std::size_t sent_ = 0;
  std::size_t chunk_ = 0;         // the first of the body's that is not wholly sent
  std::size_t within_chunk_ = 0;  // bytes of it that are
  bool write_broken_ = false;
  bool is_early_ = false;  // a 2xx came while the request was on its way
  std::size_t acknowledged_ = 0;
  loop::Instant heard_;
  loop::Instant first_left_;
  std::uint64_t sent_twice_ = 0;  // segments of this connection, before
  AnswerParser parser_;
  std::string fault_;
};

}  // namespace adit::uplink
