#pragma once

#include <cstdint>
#include <vector>

#include "intake/head_checker.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

/// Stands before libmicrohttpd on one connection: it is let on to read a request only after the request's
/// head lies whole and sound in the socket, where it is looked at without being taken.
class Gate {
 public:
  enum class Finding : std::uint8_t {
    Nothing,  // has come of the next request
    Begun,    // and the head is not whole
    Later,    // it comes in small pieces: to be looked at again at again_at()
    Whole,    // libmicrohttpd may take it
    Refused,  // by refusal()
  };

  explicit Gate(int fd) : fd_(fd) {}

  /// A request is over. The next one's head is waited for, unless it was looked at with the one before
  /// (a client that does not wait for answers).
  void request_over();
  bool is_waiting() const { return stage_ == Stage::Waiting; }
  /// What came first was not looked at yet, or has been let on and is not yet read.
  bool has_unseen() const;
  /// `at_once`: though it comes in small pieces.
  Finding look(loop::Instant now, bool at_once);
  loop::Instant again_at() const { return again_at_; }
  /// The head that is looked at.
  const HeadChecker& head() const { return head_; }

  /// Whether the request that is let in next has a body in chunks.
  bool next_is_chunked() const { return next_ < sound_.size() && !sound_[next_].framing.length; }
  /// libmicrohttpd begins a request. False: with a head that was not looked at.
  bool let_in();
  /// Of the request that was let in last.
  const Framing& framing() const { return framing_; }
  /// libmicrohttpd has read on behind the request that it was let in for, which had a length: a part of the
  /// next head would get past the gate. Asked once the request has been read.
  bool is_passed_by() const;

  bool has_refused() const { return stage_ == Stage::Refused; }
  /// Throws away what has come: a socket that is closed with bytes unread is reset, and its last answer lost.
  /// False where that was too much.
  bool read_away();

 private:
  enum class Stage : std::uint8_t { Waiting, Open, Entered, Refused };
  struct Sound {
    std::size_t head_bytes = 0;
    Framing framing;
  };
  void take_sound_heads(std::string_view bytes);

  int fd_;
  Stage stage_ = Stage::Waiting;
  HeadChecker head_;
  std::vector<Sound> sound_;  // requests with heads that libmicrohttpd may take
  std::size_t next_ = 0;      // of those
  Framing framing_;
  std::size_t looked_at_ = 0;  // bytes of the head
  loop::Instant looked_ = {};  // when
  loop::Instant again_at_ = {};
  std::uint64_t requests_end_ = 0;  // offset in all that the client sends: where the last one let in ends
  std::size_t thrown_away_ = 0;
};

}  // namespace adit::intake
