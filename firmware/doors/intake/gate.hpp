#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "intake/head_checker.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

/// Lets libmicrohttpd read a request on one connection only after the request's head has arrived whole and is
/// valid. The gate peeks at the head in the socket and does not remove it.
class Gate {
 public:
  enum class Finding : std::uint8_t {
    Nothing,  // no byte of the next request has arrived
    Begun,    // the head is not whole
    Later,    // the head arrives in small pieces; call check_bytes() again at next_check()
    Whole,    // libmicrohttpd may read it
    Refused,  // head().refusal() says why
  };

  /// `read`: bytes of the connection that were read before.
  explicit Gate(int fd, std::size_t read = 0) : fd_(fd), requests_end_(read) {}

  /// A request has ended. Waits for the next head, unless that was checked together with the previous one
  /// because the client does not wait for answers.
  void on_request_end();
  /// Bytes have arrived since the last check_bytes().
  void on_bytes() { has_new_bytes_ = true; }
  bool has_new_bytes() const { return has_new_bytes_; }
  bool is_waiting() const { return stage_ == Stage::Waiting; }
  /// True if the first bytes were not checked yet, or libmicrohttpd has not yet read a valid head.
  bool has_unseen() const;
  /// Checks the bytes in the socket. `at_once`: do not wait for more pieces.
  Finding check_bytes(loop::Instant now, bool at_once);
  loop::Instant next_check() const { return again_at_; }
  const HeadChecker& head() const { return head_; }

  /// True if the next request to let in has a chunked body. Its head is the first one in the socket.
  bool next_is_chunked() const { return next_ < sound_.size() && !sound_[next_].framing.length; }
  /// A request begins. False: its head was not checked.
  bool admit_request();
  /// Also reads the head from the socket, unseen by libmicrohttpd. False: it is not there any more.
  bool consume_head();
  /// Call once the head was read from the socket. Acknowledges it at once if its body is still to come: a
  /// client that sends head and body in two writes waits for that (Nagle's algorithm), for 40 ms by default.
  void acknowledge_head() const;
  /// Of the last request that was let in.
  const Framing& framing() const { return framing_; }
  std::string take_head_text() { return std::move(head_text_); }
  /// The kernel's counts of the connection's bytes, from the first one. If the socket is no TCP socket (a
  /// socketpair of the simulation): those of the requests that were let in.
  struct Traffic {
    std::uint64_t received;  // from the client, also unread ones
    std::uint64_t taken;     // bytes to the client that its machine has acknowledged
  };
  Traffic traffic() const;
  /// The bytes that the kernel has received and that nothing has read. 0 if it does not say.
  std::size_t unread() const;
  /// True if libmicrohttpd has read beyond the last admitted request, so that a part of the next head would
  /// not be checked. Only for a request with a length that has been read. `received`: of traffic(), just now.
  bool is_passed_by(std::uint64_t received) const;

  bool has_refused() const { return stage_ == Stage::Refused; }
  /// Discards the received bytes, because closing a socket with unread bytes resets it, and the last answer
  /// would be lost. False if there were too many bytes.
  bool discard_received();

 private:
  enum class Stage : std::uint8_t { Waiting, Open, Entered, Refused };
  struct ValidHead {
    std::string head;
    Framing framing;
  };
  void pop_valid_heads(std::string_view bytes);

  int fd_;
  Stage stage_ = Stage::Waiting;
  bool has_new_bytes_ = false;
  HeadChecker head_;
  std::vector<ValidHead> sound_;  // requests whose heads libmicrohttpd may read
  std::size_t next_ = 0;          // the next one of sound_
  Framing framing_;
  std::string head_text_;
  std::size_t looked_at_ = 0;  // checked bytes of the head
  loop::Instant looked_ = {};  // the time of the last check
  loop::Instant again_at_ = {};
  std::uint64_t requests_end_;  // the end of the last request let in, from the client's first byte
  std::size_t thrown_away_ = 0;
};

}  // namespace adit::intake
