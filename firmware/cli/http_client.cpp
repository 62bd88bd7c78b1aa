#include "cli/http_client.hpp"

#include <poll.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "cli/where.hpp"
#include "uplink/socket.hpp"

namespace adit::cli {
namespace {

using Clock = std::chrono::steady_clock;

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

/// The whole answer, or why there is none.
std::expected<HttpReply, std::string> exchanged(int fd, uplink::Exchange& exchange,
                                                Clock::time_point deadline) {
  while (true) {
    if (exchange.wants_to_write())
      exchange.write(fd);  // who hangs up while he is written to may have said why
    switch (exchange.read(fd)) {
      case uplink::Exchange::Answer::Whole:
        return exchange.take_answer();
      case uplink::Exchange::Answer::Lost:
        return std::unexpected(exchange.doubt().why);
      case uplink::Exchange::Answer::Waiting:
        break;
    }
    const short events = exchange.wants_to_write() ? POLLIN | POLLOUT : POLLIN;
    if (const int error = wait_for(fd, events, deadline); error != 0) return std::unexpected(reason(error));
  }
}

}  // namespace

std::expected<HttpReply, NoReply> http_ask(const settings::Address& address, HttpRequest request,
                                           std::chrono::milliseconds within) {
  const auto deadline = Clock::now() + within;
  const auto fail = [&](const std::string& why, bool sent) {
    return std::unexpected(NoReply{"Adit at " + written(address) + " cannot be asked: " + why, sent});
  };
  const uplink::Endpoint endpoint{.address = address.address, .port = address.port, .interface = ""};
  const auto fd = uplink::begin_connect(endpoint);
  if (!fd) return fail(fd.error().why, false);
  int error = wait_for(fd->get(), POLLOUT, deadline);
  if (error == 0) error = uplink::connect_error(fd->get());
  if (error != 0) return fail(reason(error), false);
  const icd::BearerToken token = request.token;
  uplink::Exchange exchange(endpoint, token, upstream(std::move(request)));
  auto reply = exchanged(fd->get(), exchange, deadline);
  if (!reply) return fail(reply.error(), true);
  return std::move(*reply);
}

}  // namespace adit::cli
