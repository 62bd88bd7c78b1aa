#include "cli/http_client.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "cli/where.hpp"
#include "uplink/socket.hpp"

namespace adit::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kOk = 200;

std::string reason(int error) {
  return std::system_category().message(error);
}

/// 0 or errno; ETIMEDOUT at the deadline.
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

uplink::Request upstream(HttpRequest request) {
  const bool posts = request.method == HttpRequest::Method::Post;
  const auto body = std::make_shared<const std::string>(std::move(request.body));
  uplink::Request asked{.method = posts ? "POST" : "GET",
                        .target = std::move(request.target),
                        .content_type = posts ? std::move(request.content_type) : "",
                        .body = {},
                        .longest_answer = kLargestBody};
  asked.body.append(body, {reinterpret_cast<const std::uint8_t*>(body->data()), body->size()});
  return asked;
}

/// The whole answer, or an error.
std::expected<HttpReply, std::string> exchanged(int fd, uplink::Exchange& exchange,
                                                Clock::time_point deadline) {
  while (true) {
    if (exchange.wants_to_write())
      exchange.write(fd);  // after a write error, the peer's answer may still tell the reason
    switch (exchange.read(fd)) {
      case uplink::Exchange::Answer::Whole:
        return exchange.take_answer();
      case uplink::Exchange::Answer::Lost:
        return std::unexpected(exchange.doubt().why);
      case uplink::Exchange::Answer::Waiting:
        break;
    }
    const short events = exchange.wants_to_write() ? POLLIN | POLLOUT : POLLIN;
    const auto until =
        exchange.is_early() ? std::min(deadline, Clock::now() + uplink::Exchange::kLook) : deadline;
    const int error = wait_for(fd, events, until);
    if (error != 0 && (error != ETIMEDOUT || Clock::now() >= deadline)) return std::unexpected(reason(error));
  }
}

uplink::Endpoint endpoint_of(const settings::Address& address) {
  return {.address = address.address, .port = address.port, .interface = ""};
}

std::expected<loop::FileDescriptor, std::string> connected(const uplink::Endpoint& endpoint,
                                                           Clock::time_point deadline) {
  auto fd = uplink::begin_connect(endpoint);
  if (!fd) return std::unexpected(fd.error().why);
  int error = wait_for(fd->get(), POLLOUT, deadline);
  if (error == 0) error = uplink::connect_error(fd->get());
  if (error != 0) return std::unexpected(reason(error));
  return *std::move(fd);
}

std::string cannot_reach(const settings::Address& address, const std::string& why) {
  return "cannot reach Adit at " + written(address) + ": " + why;
}

}  // namespace

std::expected<HttpReply, NoReply> http_ask(const settings::Address& address, HttpRequest request,
                                           std::chrono::milliseconds within) {
  const auto deadline = Clock::now() + within;
  const uplink::Endpoint endpoint = endpoint_of(address);
  const auto fd = connected(endpoint, deadline);
  if (!fd) return std::unexpected(NoReply{cannot_reach(address, fd.error()), false});
  const icd::BearerToken token = request.token;
  uplink::Exchange exchange(endpoint, token, upstream(std::move(request)));
  auto reply = exchanged(fd->get(), exchange, deadline);
  if (!reply) return std::unexpected(NoReply{cannot_reach(address, reply.error()), true});
  return std::move(*reply);
}

std::expected<std::unique_ptr<HttpStream>, std::string> HttpStream::ask(const settings::Address& address,
                                                                        HttpRequest request,
                                                                        std::chrono::milliseconds within) {
  const auto deadline = Clock::now() + within;
  const uplink::Endpoint endpoint = endpoint_of(address);
  auto fd = connected(endpoint, deadline);
  if (!fd) return std::unexpected(cannot_reach(address, fd.error()));
  const icd::BearerToken token = request.token;
  auto stream = std::make_unique<HttpStream>(*std::move(fd), endpoint, token, upstream(std::move(request)));
  while (stream->exchange_.wants_to_write()) {
    if (stream->exchange_.write(stream->fd()) != 0) break;  // read() returns the reason
    if (!stream->exchange_.wants_to_write()) break;
    if (const int error = wait_for(stream->fd(), POLLOUT, deadline); error != 0) {
      return std::unexpected(cannot_reach(address, reason(error)));
    }
  }
  return stream;
}

HttpStream::HttpStream(loop::FileDescriptor fd, const uplink::Endpoint& endpoint,
                       const icd::BearerToken& token, uplink::Request request)
    : fd_(std::move(fd)), exchange_(endpoint, token, std::move(request)) {}

std::expected<std::string, HttpStream::Ended> HttpStream::read() {
  if (!ended_) look();
  std::string came = exchange_.status() == kOk ? exchange_.take_part() : "";
  if (ended_ && came.empty()) return std::unexpected(*ended_);
  return came;
}

void HttpStream::look() {
  const auto answer = exchange_.read(fd());
  if (answer == uplink::Exchange::Answer::Lost) ended_ = {.why = exchange_.doubt().why};
  if (answer == uplink::Exchange::Answer::Whole) {
    ended_ = {.status = exchange_.status() == kOk ? 0 : exchange_.status(), .why = "closed by the server"};
  }
}

}  // namespace adit::cli
