#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <expected>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "loop/file_descriptor.hpp"
#include "rehearsal/command_post/endpoint.hpp"
#include "rehearsal/common.hpp"

namespace adit::rehearsal {

/// The link to the Command Post. All connections share its rate in megabits a second: the pieces that they
/// receive arrive one after the other. Safe for use by several threads.
class Link {
 public:
  explicit Link(double megabits) : bits_per_second_(megabits * 1e6) {}

  /// The time from now until `bytes` more have arrived.
  std::chrono::milliseconds pass(std::size_t bytes) {
    constexpr double bits_of_a_byte = 8;
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    free_ = std::max(free_, now) + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                                       static_cast<double>(bytes) * bits_of_a_byte / bits_per_second_));
    return std::chrono::floor<std::chrono::milliseconds>(free_ - now);
  }

 private:
  std::mutex mutex_;
  const double bits_per_second_;
  Clock::time_point free_;  // when the last received piece has arrived
};

/// In UTC, by a format of strftime(3). No program here has a locale.
std::string utc_text(const char* format, std::chrono::system_clock::time_point time);

/// The answer's bytes, without a body for HEAD, with a Date as of servers with a clock (RFC 9110 6.6.1).
std::string bytes_of(const Outcome& outcome, bool head, std::chrono::system_clock::time_point now);

/// How an endpoint behaves below its messages.
struct WireManner {
  bool answers_expect = true;         // sends 100 Continue if the client asks for it
  std::chrono::seconds patience{60};  // with a connection that sends nothing
  std::size_t most_body = std::size_t{256} << 20;
  bool slash = false;                    // at the end of each path
  bool serial = false;                   // serves one connection at a time
  std::shared_ptr<Link> link = nullptr;  // all connections share it; null: no limit
};

/// Decides the reaction to a request; several threads call it at once. bytes_of() has the result on the wire.
using Decide = std::function<Outcome(const Request&)>;

/// A listening socket and one thread for each connection, at most kMostConnections.
class Server {
 public:
  static constexpr int kMostConnections = 128;

  /// An error says which address could not be listened on, and why.
  static std::expected<std::unique_ptr<Server>, std::string> listen(const Address& address, WireManner manner,
                                                                    Decide decide);
  /// Stops, and waits for all connections.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// The address on which it listens, with the assigned port.
  const Address& address() const { return address_; }

  /// Stops listening and makes every connection end, without waiting for them. Any thread may call it.
  void stop();

  /// Waits until the last connection has ended; false: not within `patience`.
  bool wait_until_drained(std::chrono::milliseconds patience);

 private:
  Server(loop::FileDescriptor listener, loop::FileDescriptor stop_event, WireManner manner, Decide decide);
  void accept_all();
  void begin(loop::FileDescriptor socket);
  void serve(loop::FileDescriptor socket);
  void on_connection_ended();

  loop::FileDescriptor listener_;
  loop::FileDescriptor stop_event_;  // readable from stop() on
  const Address address_;
  const WireManner manner_;
  const Decide decide_;
  std::mutex mutex_;
  std::condition_variable ended_;
  int connections_ = 0;
  std::thread acceptor_;
};

}  // namespace adit::rehearsal
