#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "intake/deadline.hpp"
#include "intake/engine.hpp"
#include "intake/gate.hpp"
#include "intake/shares.hpp"
#include "loop/guard.hpp"
#include "loop/loop.hpp"

struct MHD_Connection;

namespace adit::intake {

class Request;
enum class Next : std::uint8_t;

/// One client's connection, from accept to close. Lives as long as libmicrohttpd's connection.
class Client {
 public:
  struct Addresses {
    std::string peer, local;
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
  Engine& engine() const { return engine_; }
  /// For the shares; nullopt if the connection is closing.
  std::optional<Held> held() const;
  /// Closes the connection to make room for another one. If a request is not answered yet, the client gets a
  /// 503.
  void give_way();
  /// Both directions are closed, or the connection was reset. A client that has closed only its own direction
  /// may still read.
  bool hung_up() const { return hung_up_; }

  /// Keeps libmicrohttpd from reading until the next request's head is whole and valid. Call this
  /// in its callbacks only at the end of a request whose connection stays. Reads on in a chunked body.
  void hold_back();
  Gate& gate() { return gate_; }
  void request_begun(std::shared_ptr<Request> request);
  /// `is_answered`: the answer was sent completely.
  void request_over(bool is_answered);
  const std::shared_ptr<Request>& request() const { return request_; }
  /// Calls `step`, which goes on with the request. If it throws, the request fails.
  template <class Step>
  Next guarded(const Step& step) {
    Next next{};
    return loop::guarded("a request", [&] { next = step(); }) ? next : fail();
  }

  Deadline& deadline() { return deadline_; }
  /// The client must read each part of a stream within kStreamWithin. The kernel holds few unsent bytes,
  /// because they would become old there.
  void expect_stream();
  static constexpr std::chrono::milliseconds kStreamWithin{30000};
  /// Call this after deadline().at().
  void late();

  /// Both have no effect if the connection is already in that state. suspend() must not be called while
  /// libmicrohttpd adds the connection.
  void suspend();
  void resume();
  bool suspended() const { return suspended_; }

  /// Writes past libmicrohttpd, which must have no bytes to write.
  void say(std::string_view text);
  /// Then closes the sending direction.
  void say_last(std::string_view text);
  /// Closes both directions. libmicrohttpd notices in its next run.
  void cut();

 private:
  Held::Doing doing() const;
  void enter(Phase phase);
  void await_head();
  /// RFC 9112 9.3. Also false if the answer is uncertain: a Connection field other than keep-alive, or
  /// HTTP/1.0.
  bool client_keeps_connection() const;
  void happened(std::uint32_t events);
  void look_at_head();
  void refuse_head();
  Next fail();
  bool begin_chunked();
  void read_on();

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
