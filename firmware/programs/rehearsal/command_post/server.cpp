#include "rehearsal/command_post/server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/dynamic_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <exception>
#include <system_error>

#include "icd/sentence.hpp"

namespace adit::rehearsal {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
/// Takes no memory for a length that is only announced.
using Parser = http::request_parser<http::dynamic_body>;
using asio::ip::tcp;
using boost::system::error_code;
using Milliseconds = std::chrono::milliseconds;

constexpr std::uint32_t kMostHeader = 16 * 1024;
constexpr std::size_t kPiece = std::size_t{64} << 10;
constexpr Milliseconds kForEver{-1};

/// poll(2), again after a signal. Returns how many are ready, 0 after `patience`.
int poll_retrying(std::array<pollfd, 2>& waited, Milliseconds patience) {
  int ready = -1;
  do {
    ready = ::poll(waited.data(), waited.size(), static_cast<int>(patience.count()));
  } while (ready < 0 && errno == EINTR);
  return ready;
}

/// A TCP socket that listens on `address`. The error is a sentence.
std::expected<loop::FileDescriptor, std::string> listening_socket(const Address& address) {
  const auto failed = [&] {
    return std::unexpected(address.text() + ": " + std::error_code(errno, std::generic_category()).message());
  };
  error_code wrong;
  const tcp::endpoint endpoint(asio::ip::make_address(address.host, wrong), address.port);
  if (wrong) return std::unexpected(address.text() + ": not a numeric address");
  loop::FileDescriptor socket(
      ::socket(endpoint.protocol().family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return failed();
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(socket.get(), endpoint.data(), static_cast<socklen_t>(endpoint.size())) != 0) return failed();
  if (::listen(socket.get(), SOMAXCONN) != 0) return failed();
  return socket;
}

/// The address that a socket is bound to.
Address local_address_of(int socket) {
  tcp::endpoint bound;
  auto size = static_cast<socklen_t>(bound.capacity());
  if (::getsockname(socket, bound.data(), &size) != 0) return {};
  bound.resize(size);
  return {bound.address().to_string(), bound.port()};
}

std::optional<std::string> field(const http::fields& fields, http::field name) {
  const auto found = fields.find(name);
  if (found == fields.end()) return std::nullopt;
  return std::string(found->value());
}

/// Why a request did not arrive whole.
HttpFault fault_of(const error_code& error) {
  if (error == asio::error::timed_out) return {408, "The request was not complete in time"};
  if (error == http::error::partial_message) return {0, "The client closed the connection within a request"};
  if (error == http::error::body_limit) return {413, "The body is larger than this Command Post accepts"};
  if (error == http::error::header_limit) return {431, "The header is larger than this Command Post accepts"};
  return {400, "Not an HTTP/1.1 request: " + error.message()};
}

/// RFC 9112 3.2; RFC 9110 5.3: a field that is no list stands once.
std::string head_fault_of(const http::request_header<>& head) {
  using enum http::field;
  constexpr unsigned kFirstWithHost = 11;  // HTTP/1.1
  if (head.version() >= kFirstWithHost && head.count(host) == 0) return "Host: missing (RFC 9112 3.2)";
  for (const auto name : {host, authorization, content_type, content_encoding, origin}) {
    if (head.count(name) > 1) return std::string(http::to_string(name)) + ": given twice (RFC 9110 5.3)";
  }
  return "";
}

void read_request_header(const Parser& parser, const WireManner& manner, Request& request) {
  const auto& message = parser.get();
  request.method = std::string(message.method_string());
  request.target = std::string(message.target());
  request.path = path_of(request.target);
  if (manner.slash && request.path.ends_with('/')) request.path.pop_back();
  request.authorization = field(message, http::field::authorization);
  request.content_type = field(message, http::field::content_type);
  request.content_encoding = field(message, http::field::content_encoding);
  request.origin = field(message, http::field::origin);
  request.head_fault = head_fault_of(message);
  request.expects_continue = field(message, http::field::expect).has_value();
  request.keep_alive = message.keep_alive();
}

/// One connection of a client: reads requests and writes the outcome of each, one after the other.
class Connection {
 public:
  /// `stop_event`: becomes readable when the connection is to end.
  Connection(loop::FileDescriptor socket, int stop_event, const WireManner& manner, const Decide& decide)
      : socket_(std::move(socket)), stop_event_(stop_event), manner_(manner), decide_(decide) {
    buffer_.reserve(kPiece);
  }

  /// Until the connection ends. Returns whether a request killed the endpoint.
  bool serve() {
    while (auto request = read_request()) {
      Outcome outcome = decide_(*request);
      while (outcome.kind == Outcome::Kind::Later) {
        if (wait(0, outcome.delay) == Event::Stopped) return false;
        outcome = outcome.then();
      }
      if (!request->keep_alive && outcome.after == ConnectionAction::KeepOpen)
        outcome.after = ConnectionAction::Close;
      const bool answers = outcome.kind == Outcome::Kind::Answered && outcome.answer.status != 0;
      if (outcome.kind == Outcome::Kind::Dies) return true;
      if (outcome.kind == Outcome::Kind::Hangs) wait(0, kForEver);
      if (!answers && outcome.kind != Outcome::Kind::Breaks) return false;
      if (answers)
        outcome.bytes = bytes_of(outcome, request->method == "HEAD", std::chrono::system_clock::now());
      if (!write(outcome.bytes)) return false;
      if (outcome.after == ConnectionAction::KeepOpen) continue;
      end(outcome.after);
      return false;
    }
    return false;
  }

  // Beast reads from a connection as from a stream.
  template <class Buffers>
  std::size_t read_some(const Buffers& buffers, error_code& error) {
    const Event event = wait(POLLIN, manner_.patience);
    if (event != Event::Ready) {
      error = event == Event::Late ? asio::error::timed_out : asio::error::operation_aborted;
      return 0;
    }
    const asio::mutable_buffer piece = *asio::buffer_sequence_begin(buffers);
    const ssize_t got = ::recv(socket_.get(), piece.data(), piece.size(), 0);
    if (got <= 0) {
      error = asio::error::eof;
      return 0;
    }
    const auto bytes = static_cast<std::size_t>(got);
    if (manner_.link && wait(0, manner_.link->pass(bytes)) == Event::Stopped)
      error = asio::error::operation_aborted;
    return bytes;
  }
  template <class Buffers>
  std::size_t read_some(const Buffers& buffers) {
    error_code error;
    const std::size_t got = read_some(buffers, error);
    if (error) throw boost::system::system_error(error);
    return got;
  }

 private:
  enum class Event { Ready, Late, Stopped };

  /// Waits for the socket's `events`, or for the stop alone if there are none.
  Event wait(short events, Milliseconds patience) const {
    const int socket = events != 0 ? socket_.get() : -1;
    std::array<pollfd, 2> waited = {pollfd{stop_event_, POLLIN, 0}, pollfd{socket, events, 0}};
    if (poll_retrying(waited, patience) <= 0) return Event::Late;
    return waited[0].revents != 0 ? Event::Stopped : Event::Ready;
  }

  /// Nothing if there is no further request: closed, idle for too long, or stopped.
  std::optional<Request> read_request() {
    Parser parser;
    parser.header_limit(kMostHeader);
    parser.body_limit(manner_.most_body);
    Request request;
    request.local_address = local_address_of(socket_.get()).text();
    error_code error;
    http::read_header(*this, buffer_, parser, error);
    request.at = Clock::now();
    if (!error) {
      read_request_header(parser, manner_, request);
      if (request.expects_continue && manner_.answers_expect && !write("HTTP/1.1 100 Continue\r\n\r\n")) {
        request.fault = HttpFault{0, "The client closed the connection before 100 Continue"};
        return request;
      }
      http::read(*this, buffer_, parser, error);
    }
    if (!parser.got_some() || error == asio::error::operation_aborted) return std::nullopt;
    if (error) request.fault = fault_of(error);
    request.whole = Clock::now();
    request.ended = std::chrono::system_clock::now();
    request.body = boost::beast::buffers_to_string(parser.get().body().data());
    return request;
  }

  bool write(std::string_view bytes) const {
    while (!bytes.empty()) {
      if (wait(POLLOUT, Milliseconds(10'000)) != Event::Ready) return false;
      const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent < 0 && (errno == EAGAIN || errno == EINTR)) continue;
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  void end(ConnectionAction after) const {
    if (after == ConnectionAction::Reset) {  // closing sends a RST, and nothing that is still to be sent
      const linger at_once{.l_onoff = 1, .l_linger = 0};
      ::setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
      return;
    }
    // Reads on briefly after the last answer, because a reset by a close with unread bytes may lose it.
    constexpr Milliseconds patience{500};
    ::shutdown(socket_.get(), SHUT_WR);
    const auto until = Clock::now() + patience;
    std::array<char, kPiece> piece;
    while (Clock::now() < until && wait(POLLIN, patience) == Event::Ready) {
      if (::recv(socket_.get(), piece.data(), piece.size(), 0) <= 0) return;
    }
  }

  loop::FileDescriptor socket_;
  const int stop_event_;
  const WireManner& manner_;
  const Decide& decide_;
  boost::beast::flat_buffer buffer_;  // received, not yet parsed
};

void log_aborted(const char* why) {
  std::fprintf(stderr, "adit-rehearsal: connection aborted: %s\n", why);
}

}  // namespace

std::string utc_text(const char* format, std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm utc{};
  (void)gmtime_r(&seconds, &utc);
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &utc)};
}

std::string bytes_of(const Outcome& outcome, bool head, std::chrono::system_clock::time_point now) {
  const Answer& answer = outcome.answer;
  const auto reason = http::obsolete_reason(http::int_to_status(static_cast<unsigned>(answer.status)));
  std::string bytes = icd::sentence("HTTP/1.1 ", answer.status, " ", std::string_view(reason),
                                    "\r\nContent-Length: ", answer.body.size(),
                                    "\r\nDate: ", utc_text("%a, %d %b %Y %H:%M:%S GMT", now));
  if (!answer.content_type.empty()) bytes += "\r\nContent-Type: " + answer.content_type;
  for (const auto& [name, value] : answer.headers) bytes += icd::sentence("\r\n", name, ": ", value);
  bytes += outcome.after == ConnectionAction::Close ? "\r\nConnection: close" : "\r\nConnection: keep-alive";
  return bytes.append("\r\n\r\n").append(head ? "" : answer.body);
}

std::expected<std::unique_ptr<Server>, std::string> Server::listen(const Address& address, WireManner manner,
                                                                   Decide decide) {
  auto listener = listening_socket(address);
  if (!listener) return std::unexpected(std::move(listener.error()));
  if (manner.link) {  // else a whole map waits here, and its sender takes it for sent
    constexpr int most_waiting = 64 << 10;
    ::setsockopt(listener->get(), SOL_SOCKET, SO_RCVBUF, &most_waiting, sizeof most_waiting);
  }
  loop::FileDescriptor stop_event(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!stop_event) return std::unexpected(address.text() + ": no more file descriptors");
  return std::unique_ptr<Server>(
      new Server(std::move(*listener), std::move(stop_event), manner, std::move(decide)));
}

Server::Server(loop::FileDescriptor listener, loop::FileDescriptor stop_event, WireManner manner,
               Decide decide)
    : listener_(std::move(listener)),
      stop_event_(std::move(stop_event)),
      address_(local_address_of(listener_.get())),
      manner_(manner),
      decide_(std::move(decide)),
      acceptor_([this] { accept_all(); }) {}

Server::~Server() {
  stop();
  acceptor_.join();
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return connections_ == 0; });
}

void Server::stop() {
  // Nobody connects between now and the acceptor's end; those in the queue are reset.
  ::shutdown(listener_.get(), SHUT_RDWR);
  ::eventfd_write(stop_event_.get(), 1);
}

bool Server::wait_until_drained(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, patience, [this] { return connections_ == 0; });
}

void Server::accept_all() {
  while (true) {
    std::array<pollfd, 2> waited = {pollfd{stop_event_.get(), POLLIN, 0}, pollfd{listener_.get(), POLLIN, 0}};
    if (poll_retrying(waited, kForEver) < 0 || waited[0].revents != 0) return;
    loop::FileDescriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!socket) {
      if ((waited[1].revents & (POLLHUP | POLLERR)) != 0) return;
      continue;
    }
    const int yes = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    {
      const std::lock_guard lock(mutex_);
      if (connections_ == kMostConnections) continue;  // closes it
      ++connections_;
    }
    manner_.serial ? serve(std::move(socket)) : begin(std::move(socket));
  }
}

/// If no thread can be started, closes the connection; others are still accepted.
void Server::begin(loop::FileDescriptor socket) {
  try {
    std::thread([this, held = std::move(socket)]() mutable { serve(std::move(held)); }).detach();
  } catch (const std::exception& error) {
    log_aborted(error.what());
    on_connection_ended();
  }
}

void Server::serve(loop::FileDescriptor socket) {
  try {
    Connection connection(std::move(socket), stop_event_.get(), manner_, decide_);
    if (connection.serve()) stop();
  } catch (const std::exception& error) {  // memory that has run out
    log_aborted(error.what());
  }
  on_connection_ended();
}

/// A connection's last use of this object: a waiting thread may destroy the object once the lock is free.
void Server::on_connection_ended() {
  const std::lock_guard lock(mutex_);
  --connections_;
  ended_.notify_all();
}

}  // namespace adit::rehearsal
