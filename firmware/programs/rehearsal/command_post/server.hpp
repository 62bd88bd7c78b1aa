#pragma once

#include <chrono>
#include <condition_variable>
#include <expected>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "loop/file_descriptor.hpp"
#include "rehearsal/command_post/address.hpp"
#include "rehearsal/command_post/http.hpp"
#include "rehearsal/command_post/link.hpp"

namespace adit::rehearsal {

/// How an endpoint behaves below its messages.
struct WireManner {
  bool answers_expect = true;         // sends 100 Continue where it is asked to
  std::chrono::seconds patience{60};  // with a connection that sends nothing
  std::size_t most_body = std::size_t{256} << 20;
  bool slash = false;                    // at the end of each path
  bool serial = false;                   // serves one connection at a time
  std::shared_ptr<Link> link = nullptr;  // all connections share it; null: no limit
};

/// Decides what is done about a request; called by several threads at once. See bytes_of() for how it is
/// done.
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

  /// Where it listens, with the port that it got.
  const Address& address() const { return address_; }

  /// Stops listening and makes every connection end, without waiting for them. Any thread may call it.
  void stop();

  /// Waits until the last connection has ended; false: not within `patience`.
  bool drained(std::chrono::milliseconds patience);

 private:
  Server(loop::FileDescriptor listener, loop::FileDescriptor stop_event, Address address, WireManner manner,
         Decide decide);
  void accept_all();
  void begin(loop::FileDescriptor socket);
  void serve(loop::FileDescriptor socket);
  void over();

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
