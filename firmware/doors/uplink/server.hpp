#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "loop/loop.hpp"
#include "uplink/connection.hpp"

namespace adit::uplink {

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

}  // namespace adit::uplink
