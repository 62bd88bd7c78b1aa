#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "uplink/connection.hpp"

namespace adit::uplink {

/// The peer's end of one connection: raw, blocking, with a timeout of twenty seconds.
class Wire {
 public:
  explicit Wire(loop::FileDescriptor fd);

  /// The head of the next request; "" if the other side has closed. Its body may follow unread.
  std::string read_head();
  /// The complete next request: head, and body by Content-Length.
  std::string read_request();
  /// The complete request that begins with this head; "" if the other side has closed.
  std::string read_rest(const std::string& head);
  /// At most `most` bytes; 0 if the other side has closed.
  std::size_t read_some(std::size_t most);
  /// False where the other side is gone.
  bool write(std::string_view bytes);
  void wait_for_close();
  /// Whether the other side ended it with a reset, once nothing more came.
  bool was_reset() const { return was_reset_; }
  /// Closes; with a reset where bytes are unread, as TCP does.
  void close() { fd_ = {}; }
  /// Closes with a reset in any case.
  void reset();

 private:
  loop::FileDescriptor fd_;
  std::string unread_;
  bool was_reset_ = false;
};

/// A scripted Command Post in a thread of its own. It serves one connection after the other: the first by the
/// first script, and so on, and all further ones by the last script. A connection is closed when its script
/// returns.
class Peer {
 public:
  using Script = std::function<void(Wire&)>;

  explicit Peer(std::vector<Script> scripts, const char* address = "127.0.0.1");
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Of each connection from now on: bytes that nobody has read.
  void hold(int bytes);
  /// Serves all connections at the same time. Call before listen().
  void serve_all_at_once() { all_at_once_ = true; }
  /// Refuses connections until now.
  void listen();

  Endpoint endpoint() const;
  /// How many scripts have begun and ended.
  int begun() const { return begun_; }
  int ended() const { return ended_; }

 private:
  void serve();
  void serve(Wire wire);

  std::vector<Script> scripts_;
  std::string address_;
  loop::FileDescriptor listener_;
  std::atomic<int> begun_ = 0, ended_ = 0;
  bool all_at_once_ = false;
  std::vector<std::jthread> threads_;
  std::thread thread_;
};

/// A Peer that listens from the start.
class ListeningPeer : public Peer {
 public:
  explicit ListeningPeer(std::vector<Script> scripts, const char* address = "127.0.0.1")
      : Peer(std::move(scripts), address) {
    listen();
  }
  explicit ListeningPeer(Script script) : ListeningPeer(std::vector<Script>{std::move(script)}) {}
};

/// A whole answer with a length.
std::string answer(std::string_view status, std::string_view body, std::string_view fields = "");

/// How a Command Post that insists on a slash at the end of each path answers a request without one; "" if it
/// has one.
std::string without_slash(std::string_view request);

/// Answers each request on the connection with the same bytes until the other side closes.
Peer::Script always(std::string bytes);

}  // namespace adit::uplink
