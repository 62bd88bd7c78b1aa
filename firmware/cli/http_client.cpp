#include "cli/http_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <system_error>

#include "cli/where.hpp"
#include "loop/file_descriptor.hpp"
#include "uplink/answer_parser.hpp"

namespace adit::cli {
namespace {

using Clock = std::chrono::steady_clock;
using State = uplink::AnswerParser::State;

std::string reason(int error) {
  return std::system_category().message(error);
}

/// 0, or the errno; ETIMEDOUT past the deadline.
int wait_for(int fd, short events, Clock::time_point deadline) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return ETIMEDOUT;
    pollfd entry{fd, events, 0};
    const int ready = poll(&entry, 1, static_cast<int>(left));
    if (ready > 0) return 0;
    if (ready < 0 && errno != EINTR) return errno;
  }
}

socklen_t fill(const settings::Address& address, sockaddr_storage& name) {
  auto& ipv4 = reinterpret_cast<sockaddr_in&>(name);
  if (inet_pton(AF_INET, address.address.c_str(), &ipv4.sin_addr) == 1) {
    ipv4.sin_family = AF_INET;
    ipv4.sin_port = htons(address.port);
    return sizeof ipv4;
  }
  auto& ipv6 = reinterpret_cast<sockaddr_in6&>(name);
  inet_pton(AF_INET6, address.address.c_str(), &ipv6.sin6_addr);
  ipv6.sin6_family = AF_INET6;
  ipv6.sin6_port = htons(address.port);
  return sizeof ipv6;
}

std::expected<loop::FileDescriptor, int> connected(const settings::Address& address,
                                                   Clock::time_point deadline) {
  sockaddr_storage name{};
  const socklen_t size = fill(address, name);
  loop::FileDescriptor fd(socket(name.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd) return std::unexpected(errno);
  if (connect(fd.get(), reinterpret_cast<const sockaddr*>(&name), size) == 0) return fd;
  if (errno != EINPROGRESS) return std::unexpected(errno);
  if (const int error = wait_for(fd.get(), POLLOUT, deadline); error != 0) return std::unexpected(error);
  int error = 0;
  socklen_t length = sizeof error;
  getsockopt(fd.get(), SOL_SOCKET, SO_ERROR, &error, &length);
  if (error != 0) return std::unexpected(error);
  return fd;
}

int send_all(int fd, std::string_view text, Clock::time_point deadline) {
  while (!text.empty()) {
    const ssize_t count = send(fd, text.data(), text.size(), MSG_NOSIGNAL);
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      if (const int error = wait_for(fd, POLLOUT, deadline); error != 0) return error;
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

/// The whole answer, or a sentence.
std::string receive(int fd, uplink::AnswerParser& parser, Clock::time_point deadline) {
  char buffer[65536];
  State state = State::Incomplete;
  while (state == State::Incomplete) {
    const ssize_t count = recv(fd, buffer, sizeof buffer, 0);
    if (count > 0) {
      state = parser.feed({buffer, static_cast<std::size_t>(count)});
    } else if (count == 0) {
      state = parser.feed_end();
    } else if (errno == EAGAIN) {
      if (const int error = wait_for(fd, POLLIN, deadline); error != 0) return reason(error);
    } else if (errno != EINTR) {
      return reason(errno);
    }
  }
  return state == State::Whole ? "" : parser.fault();
}

/// All but the body.
std::string head_of(const HttpRequest& request, const std::string& host) {
  const bool posts = request.method == HttpRequest::Method::Post;
  std::string text = posts ? "POST " : "GET ";
  text.append(request.target).append(" HTTP/1.1\r\nHost: ").append(host).append("\r\n");
  text.append("Accept: application/json\r\nConnection: close\r\n");
  if (posts) {
    text.append("Content-Type: ")
        .append(request.content_type)
        .append("\r\nContent-Length: ")
        .append(std::to_string(request.body.size()))
        .append("\r\n");
  }
  if (request.token) text.append("Authorization: Bearer ").append(request.token->reveal()).append("\r\n");
  return text.append("\r\n");
}

}  // namespace

std::expected<HttpReply, NoReply> http_ask(const settings::Address& address, const HttpRequest& request,
                                           std::chrono::milliseconds within) {
  const auto deadline = Clock::now() + within;
  const std::string host = written(address);
  const auto fail = [&host](const std::string& why, bool sent) {
    return std::unexpected(NoReply{"Adit at " + host + " cannot be asked: " + why, sent});
  };
  const auto fd = connected(address, deadline);
  if (!fd) return fail(reason(fd.error()), false);
  int error = send_all(fd->get(), head_of(request, host), deadline);
  if (error == 0) error = send_all(fd->get(), request.body, deadline);
  // Who refuses a long body says so and hangs up before it is whole.
  const bool hung_up = error == EPIPE || error == ECONNRESET;
  if (error != 0 && !hung_up) return fail(reason(error), true);
  uplink::AnswerParser parser(kLargestBody);
  if (const std::string trouble = receive(fd->get(), parser, deadline); !trouble.empty()) {
    return fail(hung_up ? reason(error) : trouble, true);
  }
  uplink::Answered answered = parser.take();
  return HttpReply{static_cast<unsigned>(answered.status), std::move(answered.body)};
}

}  // namespace adit::cli
