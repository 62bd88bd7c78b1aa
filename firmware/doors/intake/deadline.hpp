#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "intake/gate.hpp"
#include "intake/least_rate.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

class Engine;

/// The time at which a client is late: it must send or read bytes within a time, or at the least rate.
class Deadline {
 public:
  Deadline(Engine& engine, const Gate& gate) : engine_(engine), gate_(gate) {}

  loop::Instant at() const { return at_; }
  /// The client has shown a token.
  bool is_authenticated() const { return authenticated_; }
  void set_authenticated(bool authenticated) { authenticated_ = authenticated; }
  /// The client must send bytes within that time.
  void expect_bytes(std::chrono::milliseconds within);
  /// The client must read the last answer of its connection within 2 s.
  void expect_last_reading();
  /// The client must send a head, or the rest of the body: an unauthenticated client within
  /// Listen::unauthenticated_within, an authenticated one within Listen::rate_over, or at the least rate.
  void expect_head();
  void expect_body();
  void body_came(std::size_t bytes);
  /// The client must read its answer at the least rate. `taken`: of Gate::traffic() before the answer.
  void expect_steady_reading(std::uint64_t taken);
  void expect_nothing();

  /// The client has closed its direction: libmicrohttpd has little time to read the last bytes.
  void client_ended();
  bool has_client_ended() const { return ended_; }
  /// Call this after at(). False: the client has more time, until the new at(). True: it is late, and has no
  /// deadline any more.
  bool is_late();

 private:
  bool keeps_up();
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

}  // namespace adit::intake
