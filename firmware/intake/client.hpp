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
#include "loop/loop.hpp"

struct MHD_Connection;

namespace adit::intake {

class Request;

/// What a client's connection asks of its server.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual loop::Instant now() const = 0;
  virtual const Listen& listen() const = 0;
  /// Runs libmicrohttpd soon, from the loop: after anything that it cannot see by itself.
  virtual void run_soon() = 0;
  /// The server looks at its clients' deadlines no later than this.
  virtual void look_at(loop::Instant when) = 0;
  virtual void tell(Ended why, const std::string& address) = 0;
  /// Once libmicrohttpd has run, the client of that number is held back.
  virtual void hold_back_soon(std::uint64_t number) = 0;
};

/// One client's connection, from accept to close. Lives exactly as long as libmicrohttpd's own.
class Client {
 public:
  /// What the server waits for; each has its own deadline.
  enum class Phase : std::uint8_t {
    Head,     // of a request that has begun, or of the first
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
  /// As the shares see it; nothing once it is on its way out.
  std::optional<Held> held() const;
  bool is_known() const { return known_; }
  void is_known(bool known) { known_ = known; }
  /// Ends, so that another has room; if a request is under way, the client is told so.
  void give_way();
  /// Both directions are over, or the connection was reset. A client that only ends its own direction is not
  /// gone: it may still read.
  bool hung_up() const { return hung_up_; }

  /// Keeps libmicrohttpd from reading until the next request's head is whole and sound. Not to be called from
  /// within its callbacks.
  void hold_back();
  Gate& gate() { return gate_; }
  /// libmicrohttpd has read the request's line.
  void head_begun(std::string_view target);
  const std::string& target() const { return target_; }
  void request_begun(std::shared_ptr<Request> request);
  void request_over();
  const std::shared_ptr<Request>& request() const { return request_; }

  /// The client has to send something, or to take what it is sent, within that time.
  void expect_bytes(std::chrono::milliseconds within);
  void expect_reading(std::chrono::milliseconds within);
  /// How long a client has to read the last answer of its connection.
  static constexpr std::chrono::milliseconds kLingerWithin{2000};
  /// The client has to send the rest of the body: a stranger soon, a known one at the least rate.
  void expect_body();
  void body_came(std::size_t bytes);
  /// The client has to take its answer at the least rate.
  void expect_steady_reading();
  /// The client has to take, within kStreamWithin, what it is sent from time to time. Of that little waits in
  /// the kernel, where it grows old.
  void expect_stream();
  static constexpr std::chrono::milliseconds kStreamWithin{30000};
  void expect_nothing();
  loop::Instant deadline() const { return deadline_; }
  /// The deadline has passed.
  void late();

  /// Both do nothing if it is so already. suspend() must not be called while libmicrohttpd takes the
  /// connection in.
  void suspend();
  void resume();
  bool suspended() const { return suspended_; }

  /// Writes past libmicrohttpd, which must have nothing of its own to write, and says that nothing follows.
  void say_last(std::string_view text);
  /// Ends the connection in both directions; libmicrohttpd finds that out in its next run.
  void cut();

 private:
  Held::Doing doing() const;
  void enter(Phase phase);
  void expect_head();
  /// Of the answer: bytes that the client's machine has taken.
  std::uint64_t taken() const;
  bool keeps_up();
  void happened(std::uint32_t events);
  void set_deadline(loop::Instant when);
  int unread() const;  // bytes
  /// The client has ended its direction, and all that it sent has been read.
  bool has_said_all() const;
  void look_at_head();
  void refuse_head();

  Engine& engine_;
  loop::Loop& loop_;
  MHD_Connection* connection_;
  int fd_;
  std::uint64_t number_;
  std::string peer_, local_;
  std::string target_;
  Phase phase_ = Phase::Head;
  loop::Instant since_;
  loop::Instant deadline_ = loop::Instant::max();
  bool bytes_expected_ = false;  // rather than reading
  bool known_ = false;
  bool leaving_ = false;            // cut
  std::optional<LeastRate> rate_;   // of its body, or of its reading
  std::uint64_t taken_before_ = 0;  // taken(), when that was looked at last
  bool ended_ = false;              // the client's direction
  bool suspended_ = false;
  bool hung_up_ = false;
  Gate gate_;
  std::shared_ptr<Request> request_;
  loop::Source arrivals_, look_again_;
};

}  // namespace adit::intake
