#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "intake/gate.hpp"
#include "intake/server.hpp"
#include "intake/shares.hpp"
#include "loop/guard.hpp"
#include "loop/loop.hpp"

struct MHD_Connection;

namespace adit::intake {

class Client;
class Request;
enum class ConnectionAction : std::uint8_t;

/// The server as a Client sees it.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual loop::Instant now() const = 0;
  virtual const Listen& listen() const = 0;
  /// Runs libmicrohttpd soon, from the loop. Call this after each change that libmicrohttpd cannot see.
  virtual void schedule_run() = 0;
  /// Makes the server check its clients' deadlines at `when` or earlier.
  virtual void schedule_check(loop::Instant when) = 0;
  virtual void on_closed(CloseReason why, const std::string& address) = 0;
  /// Calls pause_reading() of the client `number` after libmicrohttpd has run.
  virtual void schedule_hold_back(std::uint64_t number) = 0;
  /// The gate has let in a request.
  virtual void begin_request(Client& client) = 0;
};

/// Checks that bytes move at least as fast as on a slow radio: kLeast over each `window`, checked twice per
/// window. A client that stops is found within one and a half windows.
class LeastRate {
 public:
  static constexpr std::uint64_t kLeast = 1000;  // bytes a second

  LeastRate(loop::Duration window, loop::Instant now) : half_(window / 2), look_at_(now + half_) {}

  void count_bytes(std::uint64_t bytes) { in_this_half_ += bytes; }
  loop::Instant next_check() const { return look_at_; }
  /// Call this once for each next_check(), at that time or later.
  bool is_too_slow(loop::Instant now) {
    const bool is_full = std::exchange(has_half_, true);
    const std::uint64_t moved = in_last_half_ + in_this_half_;
    in_last_half_ = std::exchange(in_this_half_, 0);
    look_at_ = now + half_;
    const std::chrono::duration<double> both = 2 * half_;
    return is_full && static_cast<double>(moved) < kLeast * both.count();
  }

 private:
  loop::Duration half_;
  loop::Instant look_at_;
  std::uint64_t in_last_half_ = 0, in_this_half_ = 0;
  bool has_half_ = false;  // in_last_half_ is set
};

/// The time at which a client is late: it must send or read bytes within a time, or at the least rate.
class Deadline {
 public:
  Deadline(Engine& engine, const Gate& gate) : engine_(engine), gate_(gate) {}

  loop::Instant at() const { return at_; }
  bool is_authenticated() const { return authenticated_; }
  void set_authenticated(bool authenticated) { authenticated_ = authenticated; }
  void expect_bytes(std::chrono::milliseconds within);
  /// The client must read the last answer of its connection within 2 s.
  void expect_last_reading();
  /// The client must send a head, or the rest of the body: an unauthenticated client within
  /// Listen::unauthenticated_within, an authenticated one within Listen::rate_over, or at the least rate.
  void expect_head();
  void expect_body();
  void on_body(std::size_t bytes) {
    if (rate_) rate_->count_bytes(bytes);
  }
  /// The client must read its answer at the least rate. `taken`: of Gate::traffic() before the answer.
  void expect_steady_reading(std::uint64_t taken);
  void expect_nothing();

  /// The client has closed its direction: libmicrohttpd has little time to read the last bytes.
  void on_client_end();
  bool has_client_ended() const { return ended_; }
  /// After at(): true if late, then without a deadline; false if there is more time, until the new at().
  bool is_late();

 private:
  bool is_fast_enough();
  void set(loop::Instant when);
  void expect_rate();

  Engine& engine_;
  const Gate& gate_;
  loop::Instant at_ = loop::Instant::max();
  bool authenticated_ = false;
  bool bytes_expected_ = false;  // false: the client must read
  bool ended_ = false;           // the client has closed its direction
  std::optional<LeastRate> rate_;
  std::uint64_t taken_before_ = 0;  // the last value of Gate::Traffic::taken
};

/// One client's connection, from accept to close. Lives as long as libmicrohttpd's connection.
class Client {
 public:
  struct Addresses {
    std::string peer, local;
    std::size_t proxy_header = 0;  // bytes of it that were read; 0: the client does not speak TLS
  };
  /// The state of the connection. Each has its own deadline.
  enum class Phase : std::uint8_t {
    Head,     // a head is arriving, or the first one is awaited
    Idle,     // between requests
    Request,  // Request sets the deadlines
  };

  Client(Engine& engine, loop::Loop& loop, MHD_Connection* connection, int fd, Addresses addresses);
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  MHD_Connection* connection() const { return connection_; }
  std::uint64_t number() const { return number_; }  // from 1, unique in the process
  const std::string& peer() const { return addresses_.peer; }
  const std::string& local() const { return addresses_.local; }
  bool is_secure() const { return addresses_.proxy_header > 0; }
  Engine& engine() const { return engine_; }
  /// For the shares; nullopt if the connection is closing.
  std::optional<ConnectionInfo> held_share() const;
  /// Closes the connection to make room for another one. An unanswered request gets a 503.
  void give_way();
  /// Both directions are closed, or a reset came. A client that has closed one may still read.
  bool has_hung_up() const { return hung_up_; }

  /// Keeps libmicrohttpd from reading until the next request's head is whole and valid. Call this in its
  /// callbacks only at the end of a request whose connection stays. Reads on in a chunked body.
  void pause_reading();
  Gate& gate() { return gate_; }
  void request_begun(std::shared_ptr<Request> request);
  /// `is_answered`: the answer was sent completely.
  void on_request_end(bool is_answered);
  const std::shared_ptr<Request>& request() const { return request_; }
  /// Calls `step`, which goes on with the request. If it throws, the request fails.
  template <class Step>
  ConnectionAction run_guarded(const Step& step) {
    ConnectionAction next{};
    return loop::run_guarded("a request", [&] { next = step(); }) ? next : fail();
  }

  Deadline& deadline() { return deadline_; }
  /// The client must read each part of a stream within kStreamWithin. The kernel holds few unsent bytes,
  /// because they would become old there.
  void expect_stream();
  static constexpr std::chrono::milliseconds kStreamWithin{30000};
  /// Call this after deadline().at().
  void on_late();

  /// Idempotent. suspend() must not be called while libmicrohttpd adds the connection.
  void suspend();
  void resume();
  bool is_suspended() const { return suspended_; }

  /// Writes past libmicrohttpd, which must have no bytes to write.
  void write_text(std::string_view text);
  /// Then closes the sending direction.
  void write_last(std::string_view text);
  /// Closes both directions. libmicrohttpd notices in its next run.
  void cut();

 private:
  ConnectionInfo::Activity activity() const;
  void enter(Phase phase) { stage_ = {.phase = phase, .since = engine_.now()}; }
  void await_head();
  /// RFC 9112 9.3. Also false if uncertain: a Connection field other than keep-alive, or HTTP/1.0.
  bool client_keeps_connection() const;
  void on_events(std::uint32_t events);
  void check_head();
  void refuse_head();
  ConnectionAction fail();
  bool begin_chunked();
  void resume_reading();

  Engine& engine_;
  MHD_Connection* connection_;
  int fd_;
  std::uint64_t number_;
  Addresses addresses_;
  struct {
    Phase phase;
    loop::Instant since;
  } stage_;
  bool leaving_ = false;  // cut() was called
  /// The next or present request is chunked, and Adit reads it. libmicrohttpd stays suspended until cut();
  /// suspended_ says if Adit reads.
  bool reads_ = false;
  bool suspended_ = false;
  bool hung_up_ = false;
  Gate gate_;
  Deadline deadline_;
  std::shared_ptr<Request> request_;
  loop::Source arrivals_, look_again_;
};

}  // namespace adit::intake
