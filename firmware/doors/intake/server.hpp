#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "icd/status.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

class TokenGuesses;

/// Why the server closed a connection or refused a request.
enum class CloseReason : std::uint8_t {
  NoRoom,      // refused: its address, or all together, have as many requests in flight as allowed
  GaveWay,     // for another one: it was unauthenticated, or its address had more than its share
  Idle,        // for another one: it was between requests
  Slow,        // head, body or reading too slow
  WrongToken,  // the token was wrong, or was not checked (TokenGuesses)
  NoToken,     // a POST to a URI of the ICD without the required token
};
inline constexpr std::size_t kEndedKinds = 6;

struct Listen {
  std::string address;
  std::uint16_t port = 0;  // 0: any free port (Server::port())
  std::string interface;   // SO_BINDTODEVICE; "": not bound
  bool free_bind = false;  // also at an address that this machine does not have (yet)
  bool by_tls = false;     // stunnel passes on the connections, each with a PROXY header (ProxyListener)
  std::uint32_t connections = 128, connections_per_address = 64;  // Shares
  std::chrono::milliseconds unauthenticated_within{5000};         // unauthenticated: each head; each body
  std::chrono::milliseconds rate_over{10000};  // authenticated: each head; LeastRate's window
  std::chrono::milliseconds idle{60000};       // between requests
  std::chrono::milliseconds late{1000};        // delay of late answers (TokenGuesses)
  TokenGuesses* guesses = nullptr;             // must outlive the server; null: its own
  std::function<void(CloseReason why, const std::string& address)> on_ended =
      {};  // called for each; may be empty
};

/// The head of one request. Valid until the request ends.
class RequestHead {
 public:
  virtual ~RequestHead() = default;
  virtual std::string_view method() const = 0;
  virtual std::string_view path() const = 0;                         // decoded, without the query
  virtual std::string_view query(std::string_view name) const = 0;   // "" if absent
  virtual std::string_view header(std::string_view name) const = 0;  // "" if absent; any letter case
  virtual std::optional<std::uint64_t> content_length() const = 0;   // absent if chunked
  virtual const std::string& peer() const = 0;                       // "10.0.0.5"
  virtual const std::string& local() const = 0;  // the box's address that the client used: "10.0.0.1"
  virtual bool is_secure() const = 0;            // the client speaks TLS
};

/// Prefix of the paths of the box's API, which pages of other origins may not read.
inline constexpr std::string_view kApiPaths = "/adit/";

struct Header {
  std::string name, value;
};

struct Answer {
  icd::Status status = icd::Status::Ok;
  std::string content_type = "application/json";
  std::string body;
  std::vector<Header> headers;
};

/// Sends one long answer (server-sent events) in pieces. The destructor ends the answer.
class Stream {
 public:
  virtual ~Stream() = default;
  /// Queues `bytes`. False if the client is gone, or is kLag bytes behind and is then disconnected.
  virtual bool send(std::string_view bytes) = 0;
  /// Queues `bytes` in place of all queued pieces, except a piece that was sent in part.
  virtual bool send_instead(std::string_view bytes) = 0;
  /// Queued bytes.
  virtual std::size_t waiting() const = 0;
  static constexpr std::size_t kLag = 1u << 20;
};

/// Answers one request, now or later, on the loop, by one call of answer() or stream(). Without effect if the
/// client is gone.
class Responder {
 public:
  virtual ~Responder() = default;
  virtual void answer(Answer answer) = 0;
  virtual std::shared_ptr<Stream> stream(std::string_view content_type) = 0;
  virtual bool is_client_gone() const = 0;
};

/// A base for a Responder that gives its answers to another one, changed or later.
class PassingResponder : public Responder {
 public:
  explicit PassingResponder(std::shared_ptr<Responder> inner) : inner_(std::move(inner)) {}
  std::shared_ptr<Stream> stream(std::string_view content_type) override {
    return inner_->stream(content_type);
  }
  bool is_client_gone() const override { return inner_->is_client_gone(); }

 protected:
  Responder& inner() const { return *inner_; }

 private:
  const std::shared_ptr<Responder> inner_;
};

class BodySink {
 public:
  virtual ~BodySink() = default;
  /// A piece of the body, valid during the call. The sink receives it in either case. False: back-pressure;
  /// the connection is suspended until FlowControl::resume().
  virtual bool on_body(std::span<const std::uint8_t> piece) = 0;
  /// The body is whole. Answer now or later.
  virtual void on_end() = 0;
  /// The client is gone, or was too slow, and has no answer.
  virtual void on_gone() {}
};

/// Resumes the body of a suspended request.
class FlowControl {
 public:
  virtual ~FlowControl() = default;
  virtual void resume() = 0;
};

enum class Credentials : std::uint8_t {
  Nothing,     // unauthenticated
  WrongToken,  // a wrong token, or no token although it is required
  Token,       // a right token
  Enough,      // a session or a known device's cookie, or the request needs no token
};

class Handler {
 public:
  virtual ~Handler() = default;
  /// Called before open(). An authenticated client (Token, Enough) has room however many unauthenticated
  /// clients there are, and has the time that a slow radio needs.
  virtual Credentials read_credentials(const RequestHead& head) = 0;
  /// Called when the head is whole. May answer at once. Then the body is read and ignored up to a limit, or
  /// the connection is closed. Null is allowed only after an answer.
  virtual std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                         std::shared_ptr<FlowControl> flow) = 0;
};

/// An HTTP/1.1 server by libmicrohttpd on the loop, for one address.
///
/// shares.hpp decides which connections have room, and client.hpp which are too slow. A request without
/// room gets 503. The server buffers no body: a slow receiver causes back-pressure.
class Server {
 public:
  /// `socket`: a listening socket to use; empty: opens one at `listen`.
  static std::expected<std::unique_ptr<Server>, std::string> start(loop::Loop& loop, const Listen& listen,
                                                                   Handler& handler,
                                                                   loop::FileDescriptor socket = {});
  Server() = default;
  virtual ~Server() = default;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  virtual std::uint16_t port() const = 0;
  virtual std::size_t connections() const = 0;
  virtual std::size_t unauthenticated_connections() const = 0;
  /// Accepts no new connections; requests in flight continue. A copy of the socket still listens, and clients
  /// that connect wait for its owner.
  virtual void stop_listening() = 0;
};

}  // namespace adit::intake
