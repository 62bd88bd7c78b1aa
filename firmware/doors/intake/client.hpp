#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "intake/gate.hpp"
#include "intake/least_rate.hpp"
#include "intake/server.hpp"
#include "intake/shares.hpp"
#include "loop/guard.hpp"
#include "loop/loop.hpp"

struct MHD_Connection;

namespace adit::intake {

class Client;
class Request;
enum class Next : std::uint8_t;

/// The server as a Client sees it.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual loop::Instant now() const = 0;
  virtual const Listen& listen() const = 0;
  /// Runs libmicrohttpd soon, from the loop. Call this after each change that libmicrohttpd cannot see.
  virtual void run_soon() = 0;
  /// Makes the server check its clients' deadlines at `when` or earlier.
  virtual void look_at(loop::Instant when) = 0;
  virtual void tell(Ended why, const std::string& address) = 0;
  /// Calls hold_back() of the client `number` after libmicrohttpd has run.
  virtual void hold_back_soon(std::uint64_t number) = 0;
  /// The gate has let in a request.
  virtual void begin_request(Client& client) = 0;
};

/// One client's connection, from accept to close. Lives as long as libmicrohttpd's connection.
class Client {
 public:
  /// The state of the connection. Each has its own deadline.
  enum class Phase : std::uint8_t {
    Head,     // a head is arriving, or the first one is awaited
    Idle,     // between requests
    Request,  // Request sets the deadlines
  };

  Client(Engine& engine, loop::Loop& loop, MHD_Connection* connection, int fd, std::string peer,
         std::string local);
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  MHD_Connection* connection() const { return connection_; }
  std::uint64_t number() const { return number_; }  // RequestHead::connection()
  const std::string& peer() const { return peer_; }
  const std::string& local() const { return local_; }
  Engine& engine() const { return engine_; }
  /// For the shares; nullopt if the connection is closing.
  std::optional<Held> held() const;
  bool is_known() const { return known_; }
  void is_known(bool known) { known_ = known; }
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

  /// The client must send bytes, or must read its answer, within that time.
  void expect_bytes(std::chrono::milliseconds within);
  void expect_reading(std::chrono::milliseconds within);
  /// How long a client may take to read the last answer of its connection.
  static constexpr std::chrono::milliseconds kLingerWithin{2000};
  /// The client must send the rest of the body: an unauthenticated client within
  /// Listen::unauthenticated_within, an authenticated one at the least rate.
  void expect_body();
  void body_came(std::size_t bytes);
  /// Call this before an answer begins. True: the connection must end with it, because libmicrohttpd has read
  /// bytes of the next request that the gate has not checked.
  bool is_last_answer();
  /// The client must read its answer at the least rate.
  void expect_steady_reading();
  /// The client must read each part of a stream within kStreamWithin. The kernel holds few unsent bytes,
  /// because they would become old there.
  void expect_stream();
  static constexpr std::chrono::milliseconds kStreamWithin{30000};
  void expect_nothing();
  loop::Instant deadline() const { return deadline_; }
  /// Call this after the deadline.
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
  void expect_head();
  /// RFC 9112 9.3. Also false if the answer is uncertain: a Connection field other than keep-alive, or
  /// HTTP/1.0.
  bool client_keeps_connection() const;
  bool keeps_up();
  void happened(std::uint32_t events);
  void set_deadline(loop::Instant when);
  int unread() const;  // bytes
  /// The client has closed its direction, and all its bytes have been read.
  bool has_said_all() const;
  void look_at_head();
  void refuse_head();
  Next fail();
  bool begin_chunked();
  void read_on();

  Engine& engine_;
  loop::Loop& loop_;
  MHD_Connection* connection_;
  int fd_;
  std::uint64_t number_;
  std::string peer_, local_;
  Phase phase_ = Phase::Head;
  loop::Instant since_;
  loop::Instant deadline_ = loop::Instant::max();
  bool bytes_expected_ = false;  // false: the client must read
  bool known_ = false;
  bool leaving_ = false;            // cut() was called
  std::optional<LeastRate> rate_;   // of the body, or of reading the answer
  std::uint64_t taken_before_ = 0;  // the last value of Gate::Traffic::taken
  bool arrived_ = false;            // bytes arrived since the last look at the head
  bool ended_ = false;              // the client has closed its direction
  /// The next or present request is chunked, and Adit reads it. libmicrohttpd stays suspended until cut();
  /// suspended_ says if Adit reads.
  bool reads_ = false;
  bool suspended_ = false;
  bool hung_up_ = false;
  Gate gate_;
  std::shared_ptr<Request> request_;
  loop::Source arrivals_, look_again_;
};

}  // namespace adit::intake
