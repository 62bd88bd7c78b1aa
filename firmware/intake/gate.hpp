#pragma once

#include <cstdint>
#include <vector>

#include "intake/head_checker.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

/// Stands before libmicrohttpd on one connection: lets it read a request only once the request's head lies
/// whole and sound in the socket, where it is checked without being taken out.
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

  /// A request is over. Waits for the head of the next one, unless that was checked with the one before (the
  /// client does not wait for answers).
  void request_over();
  bool is_waiting() const { return stage_ == Stage::Waiting; }
  /// The first bytes were not looked at yet, or libmicrohttpd may read them and has not yet.
  bool has_unseen() const;
  /// `at_once`: even if the head comes in small pieces.
  Finding look(loop::Instant now, bool at_once);
  loop::Instant again_at() const { return again_at_; }
  /// The head that is looked at.
  const HeadChecker& head() const { return head_; }

  /// Whether the request that is let in next has a body in chunks.
  bool next_is_chunked() const { return next_ < sound_.size() && !sound_[next_].framing.length; }
  /// libmicrohttpd begins a request. False: its head was not checked.
  bool let_in();
  /// Of the request that was let in last.
  const Framing& framing() const { return framing_; }
  /// libmicrohttpd has read further than the end of the request that was let in, which had a length: a part
  /// of the next head would get past the gate. To be asked once the request has been read.
  bool is_passed_by() const;

  bool has_refused() const { return stage_ == Stage::Refused; }
  /// Throws away the bytes that have come: a socket that is closed with bytes unread is reset, and its last
  /// answer lost. False if there were too many.
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
