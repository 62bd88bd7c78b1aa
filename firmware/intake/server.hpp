#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "icd/status.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

class TokenGuesses;

/// Why the server ended a connection, or refused a request.
enum class Ended : std::uint8_t {
  NoRoom,      // refused: its address, or all together, have as many requests under way as allowed
  GaveWay,     // for another: a stranger's, or that of an address with more than its share
  Idle,        // for another: it was between requests
  Slow,        // its head, body or reading was too slow
  WrongToken,  // the request's token was wrong, or was not checked (TokenGuesses)
};
inline constexpr std::size_t kEndedKinds = 5;

/// Where and how the server listens.
struct Listen {
  std::string address;
  std::uint16_t port = 0;  // 0: any free port, see Server::port()
  std::string interface;   // SO_BINDTODEVICE; "": not bound
  bool free_bind = false;  // also at an address that this machine does not have, or not yet
  std::uint32_t connections = 128, connections_per_address = 64;  // Shares
  std::chrono::milliseconds stranger_within{5000};  // from connecting: the head; from there: the whole body
  std::chrono::milliseconds rate_over{10000};       // LeastRate of bodies and of reading; a known one's head
  std::chrono::milliseconds idle{60000};            // between requests
  std::chrono::milliseconds late{1000};             // how late an answer comes that is to (TokenGuesses)
  TokenGuesses* guesses = nullptr;                  // outlives the server; null: it has its own
  std::function<void(Ended why, const std::string& address)> ended = {};  // told of each; may be empty
};

/// The head of one request. Valid until the request ends.
class RequestHead {
 public:
  virtual ~RequestHead() = default;
  virtual std::string_view method() const = 0;
  virtual std::string_view path() const = 0;                         // decoded, without the query
  virtual std::string_view query(std::string_view name) const = 0;   // "" where absent
  virtual std::string_view header(std::string_view name) const = 0;  // "" where absent; any letter case
  virtual std::optional<std::uint64_t> content_length() const = 0;   // absent where chunked
  virtual const std::string& peer() const = 0;                       // "10.0.0.5"
  virtual const std::string& local() const = 0;  // the box's own that was asked: "10.0.0.1"
  virtual std::uint64_t connection() const = 0;  // its number: from 1, no two of a process alike
};

struct Header {
  std::string name, value;
};

struct Answer {
  icd::Status status = icd::Status::Ok;
  std::string content_type = "application/json";
  std::string body;
  std::vector<Header> headers;
};

/// Sends pieces of one long answer (server-sent events) as they come. Dropping it ends the answer.
class Stream {
 public:
  virtual ~Stream() = default;
  /// Queues bytes; false once the client has gone, or has fallen `kLag` bytes behind (then it is cut off).
  virtual bool send(std::string_view bytes) = 0;
  /// The same in the place of all that waits, but for what one send() gave and of which some has left.
  virtual bool send_instead(std::string_view bytes) = 0;
  /// Bytes that are queued.
  virtual std::size_t waiting() const = 0;
  static constexpr std::size_t kLag = 1u << 20;
};

/// Answers one request, now or later, on the loop, by exactly one call. Does nothing if the client has gone.
/// Copies stand for the same request.
class Responder {
 public:
  virtual ~Responder() = default;
  virtual void answer(Answer answer) = 0;
  virtual std::shared_ptr<Stream> stream(std::string_view content_type) = 0;
  virtual bool client_gone() const = 0;
};

/// Takes the body of one request.
class BodySink {
 public:
  virtual ~BodySink() = default;
  /// A piece of the body, valid during the call. False: take no more for now (back-pressure: the connection
  /// is suspended until Flow::resume()). The piece itself has been taken either way.
  virtual bool on_body(std::span<const std::uint8_t> piece) = 0;
  /// The body is whole. Answer now or later.
  virtual void on_end() = 0;
  /// The client went away, or was too slow, before it was answered.
  virtual void on_gone() {}
};

/// Lets a suspended request's body flow again.
class Flow {
 public:
  virtual ~Flow() = default;
  virtual void resume() = 0;
};

/// What the client has shown.
enum class Shown : std::uint8_t {
  Nothing,     // it is a stranger
  WrongToken,  // a wrong token, or none where one is needed
  Token,       // a right token
  Enough,      // a session, or that it has had one; or it asks for something that needs none
};

/// Takes requests.
class Handler {
 public:
  virtual ~Handler() = default;
  /// Asked before open(). A known client (Token, Enough) has room however many strangers come, and as much
  /// time as a slow radio takes.
  virtual Shown shown(const RequestHead& head) = 0;
  /// Called when the headers are whole. May answer at once (a refusal: the body is then read away up to a
  /// limit, or the connection closed). Returning nothing is allowed only after answering.
  virtual std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                         std::shared_ptr<Flow> flow) = 0;
};

/// An HTTP/1.1 server by libmicrohttpd on the loop, for one listening address.
///
/// shares.hpp decides who has room, least_rate.hpp who is too slow; a request that finds no room is answered
/// 503. The server keeps no bytes of a body: a slow receiver is back-pressure.
class Server {
 public:
  /// `socket`: one that listens already, taken instead of opening one at `listen`.
  static std::expected<std::unique_ptr<Server>, std::string> start(loop::Loop& loop, const Listen& listen,
                                                                   Handler& handler,
                                                                   loop::FileDescriptor socket = {});
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  std::size_t connections() const;
  /// Those of them that have shown no token.
  std::size_t strangers() const;
  /// Takes no new connections; requests under way go on. If there is a copy of the socket elsewhere, it still
  /// listens, and clients that connect wait for the copy's owner.
  void stop_listening();

 private:
  class Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::intake
