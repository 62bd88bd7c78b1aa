#include "rehearsal/command_post/connection.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <system_error>

#include "rehearsal/command_post/http.hpp"

namespace adit::rehearsal {
namespace {

using Infos = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Infos numeric_address(const Address& address) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(address.port);
  if (::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found) != 0) found = nullptr;
  return {found, ::freeaddrinfo};
}

}  // namespace

int poll_again(std::span<pollfd> waited, int patience_ms) {
  int ready = -1;
  do {
    ready = ::poll(waited.data(), waited.size(), patience_ms);
  } while (ready < 0 && errno == EINTR);
  return ready;
}

std::expected<loop::FileDescriptor, std::string> listening_socket(const Address& address) {
  const auto failed = [&] {
    return std::unexpected(address.text() + ": " + std::error_code(errno, std::generic_category()).message());
  };
  const Infos info = numeric_address(address);
  if (!info) return std::unexpected(address.text() + ": not a numeric address");
  loop::FileDescriptor socket(::socket(info->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return failed();
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(socket.get(), info->ai_addr, info->ai_addrlen) != 0) return failed();
  if (::listen(socket.get(), SOMAXCONN) != 0) return failed();
  return socket;
}

std::optional<Address> local_address_of(int socket) {
  sockaddr_storage storage{};
  socklen_t length = sizeof storage;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&storage), &length) != 0) return std::nullopt;
  char host[NI_MAXHOST];
  char port[NI_MAXSERV];
  if (::getnameinfo(reinterpret_cast<sockaddr*>(&storage), length, host, sizeof host, port, sizeof port,
                    NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return std::nullopt;
  }
  Address address{host, 0};
  std::from_chars(port, port + std::strlen(port), address.port);
  return address;
}

namespace {

namespace http = boost::beast::http;
using Parser = http::request_parser<HeldBody>;

constexpr std::uint32_t kMostHeader = 16 * 1024;
constexpr std::size_t kPiece = std::size_t{64} << 10;

std::optional<std::string> field(const http::fields& fields, http::field name) {
  const auto found = fields.find(name);
  if (found == fields.end()) return std::nullopt;
  return std::string(found->value());
}

HttpFault fault_of(const boost::system::error_code& error) {
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

void take_header(const Parser& parser, const WireManner& manner, Request& request) {
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

/// Feeds what was received to the parser and takes it out. Gives whether the parser needs more.
bool feed(Parser& parser, std::string& received, boost::system::error_code& error) {
  std::size_t used = 0;
  while (used < received.size() && !parser.is_done() && !error) {
    const bool had_header = parser.is_header_done();
    const std::size_t more =
        parser.put(boost::asio::buffer(received.data() + used, received.size() - used), error);
    used += more;
    // The parser stops behind the header, so that Expect can be answered before the body is waited for.
    if (more == 0 || had_header != parser.is_header_done()) break;
  }
  received.erase(0, used);
  if (error == http::error::need_more) error = {};
  return !parser.is_done();
}

}  // namespace

Connection::Arrival Connection::receive() {
  const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(manner_.patience);
  std::array<pollfd, 2> waited = {pollfd{stop_event_, POLLIN, 0}, pollfd{socket_.get(), POLLIN, 0}};
  const int ready = poll_again(waited, static_cast<int>(patience.count()));
  if (ready <= 0) return Arrival::Late;
  if (waited[0].revents != 0) return Arrival::Stopped;
  std::array<char, kPiece> piece;
  const ssize_t got = ::recv(socket_.get(), piece.data(), piece.size(), 0);
  if (got <= 0) return Arrival::Closed;
  received_.append(piece.data(), static_cast<std::size_t>(got));
  if (manner_.link && stopped_within(manner_.link->pass(static_cast<std::size_t>(got))))
    return Arrival::Stopped;
  return Arrival::Bytes;
}

std::optional<Request> Connection::read_request() {
  Parser parser;
  parser.eager(false);
  parser.header_limit(kMostHeader);
  parser.body_limit(manner_.most_body);
  Request request;
  request.local_address = local_address();
  boost::system::error_code error;
  bool begun = !received_.empty();
  bool header_taken = false;
  while (feed(parser, received_, error)) {
    if (parser.is_header_done() && !header_taken && !error) {
      header_taken = true;
      request.at = Clock::now();
      take_header(parser, manner_, request);
      parser.eager(true);
      if (request.expects_continue && manner_.answers_expect && !write("HTTP/1.1 100 Continue\r\n\r\n")) {
        request.fault = HttpFault{0, "The client closed the connection before 100 Continue"};
        return request;
      }
      continue;
    }
    if (error) break;
    const Arrival arrival = receive();
    begun = begun || arrival == Arrival::Bytes;
    if (arrival == Arrival::Bytes) continue;
    if (!begun || arrival == Arrival::Stopped) return std::nullopt;
    if (!header_taken) request.at = Clock::now();
    request.fault = arrival == Arrival::Late
                        ? HttpFault{408, "The request was not complete in time"}
                        : HttpFault{0, "The client closed the connection within a request"};
    return request;
  }
  if (!header_taken) {
    request.at = Clock::now();
    if (!error) take_header(parser, manner_, request);
  }
  if (error) request.fault = fault_of(error);
  request.whole = Clock::now();
  request.ended = std::chrono::system_clock::now();
  request.body = std::move(parser.get().body());
  return request;
}

bool Connection::write(const std::string& bytes) {
  constexpr int patience_ms = 10'000;
  std::size_t written = 0;
  while (written < bytes.size()) {
    std::array<pollfd, 2> waited = {pollfd{stop_event_, POLLIN, 0}, pollfd{socket_.get(), POLLOUT, 0}};
    if (poll_again(waited, patience_ms) <= 0 || waited[0].revents != 0) return false;
    const ssize_t sent =
        ::send(socket_.get(), bytes.data() + written, bytes.size() - written, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (sent <= 0) return false;
    written += static_cast<std::size_t>(sent);
  }
  return true;
}

bool Connection::stopped_within(std::optional<std::chrono::milliseconds> patience) const {
  std::array<pollfd, 1> waited = {pollfd{stop_event_, POLLIN, 0}};
  return poll_again(waited, patience ? static_cast<int>(patience->count()) : -1) != 0;
}

void Connection::end(After after) {
  if (after == After::Reset) {
    reset();
  } else {
    close_gently();
  }
}

/// Closing sends a RST from now on, and nothing of what still waits to be sent.
void Connection::reset() {
  const linger at_once{.l_onoff = 1, .l_linger = 0};
  ::setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
}

/// Reads on for a moment after the last answer: closing with bytes unread would send a reset, and the client
/// might never read what it was answered.
void Connection::close_gently() {
  constexpr int patience_ms = 500;
  ::shutdown(socket_.get(), SHUT_WR);
  const auto until = Clock::now() + std::chrono::milliseconds(patience_ms);
  std::array<char, kPiece> piece;
  while (Clock::now() < until) {
    std::array<pollfd, 2> waited = {pollfd{stop_event_, POLLIN, 0}, pollfd{socket_.get(), POLLIN, 0}};
    if (poll_again(waited, patience_ms) <= 0 || waited[0].revents != 0) return;
    if (::recv(socket_.get(), piece.data(), piece.size(), 0) <= 0) return;
  }
}

std::string Connection::local_address() const {
  const auto address = local_address_of(socket_.get());
  return address ? address->text() : "";
}

Connection::End Connection::serve() {
  while (auto request = read_request()) {
    Outcome outcome = decide_(*request);
    while (outcome.kind == Outcome::Kind::Later) {
      if (stopped_within(outcome.delay)) return End::Closed;
      outcome = outcome.then();
    }
    if (!request->keep_alive && outcome.after == After::KeepOpen) outcome.after = After::Close;
    switch (outcome.kind) {
      case Outcome::Kind::Dies:
        return End::EndpointDies;
      case Outcome::Kind::Hangs:
        stopped_within(std::nullopt);
        return End::Closed;
      case Outcome::Kind::Breaks:
        if (write(outcome.bytes)) end(outcome.after);
        return End::Closed;
      case Outcome::Kind::Answered:
      case Outcome::Kind::Later:
        break;
    }
    if (outcome.answer.status == 0) return End::Closed;
    if (!write(bytes_of(outcome, request->method == "HEAD", std::chrono::system_clock::now())))
      return End::Closed;
    if (outcome.after == After::KeepOpen) continue;
    end(outcome.after);
    return End::Closed;
  }
  return End::Closed;
}

}  // namespace adit::rehearsal
