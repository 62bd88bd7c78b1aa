#include "intake/raw_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "patience.hpp"

namespace adit::intake {
namespace {

using Clock = std::chrono::steady_clock;

sockaddr_in loopback(const std::string& address, std::uint16_t port) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  ::inet_pton(AF_INET, address.c_str(), &place.sin_addr);
  return place;
}

bool wait(int fd, short events, Clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
  pollfd waiting{.fd = fd, .events = events, .revents = 0};
  return ::poll(&waiting, 1, static_cast<int>(std::max<std::int64_t>(left, 0))) > 0;
}

std::size_t number_in(std::string_view text, int base) {
  std::size_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number, base);
  return number;
}

/// The complete chunked body at the start of `bytes` and its end; nothing if it is cut.
std::optional<std::pair<std::string, std::size_t>> unchunk(std::string_view bytes) {
  std::string body;
  std::size_t at = 0;
  while (true) {
    const auto line_end = bytes.find("\r\n", at);
    if (line_end == std::string_view::npos) return std::nullopt;
    const std::size_t size = number_in(bytes.substr(at, line_end - at), 16);
    at = line_end + 2;
    if (bytes.size() < at + size + 2) return std::nullopt;
    body += bytes.substr(at, size);
    at += size + 2;
    if (size == 0) return std::pair(body, at);
  }
}

Reply head_of(std::string_view head) {
  Reply reply;
  reply.status =
      static_cast<int>(number_in(head.substr(std::min<std::size_t>(head.find(' ') + 1, head.size())), 10));
  auto at = head.find("\r\n");
  while (at != std::string_view::npos && at + 2 < head.size()) {
    const auto end = head.find("\r\n", at + 2);
    const auto line = head.substr(at + 2, end == std::string_view::npos ? end : end - at - 2);
    const auto colon = line.find(": ");
    std::string name(line.substr(0, colon));
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    if (colon != std::string_view::npos) reply.headers[name] = line.substr(colon + 2);
    at = end;
  }
  return reply;
}

}  // namespace

RawClient::RawClient(std::uint16_t port, const std::string& source)
    : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const sockaddr_in from = loopback(source, 0);
  const sockaddr_in to = loopback("127.0.0.1", port);
  const int on = 1, small = 65536;
  ::setsockopt(fd_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  ::setsockopt(fd_.get(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  connected_ = ::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&from), sizeof from) == 0 &&
               ::connect(fd_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
}

void RawClient::delay_small_writes() {
  const int off = 0;
  ::setsockopt(fd_.get(), IPPROTO_TCP, TCP_NODELAY, &off, sizeof off);
}

bool RawClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

std::size_t RawClient::send_until_stalled(std::string_view bytes, std::chrono::milliseconds patience) {
  std::size_t total = 0;
  while (total < bytes.size() && wait(fd_.get(), POLLOUT, Clock::now() + patient(patience))) {
    const ssize_t sent =
        ::send(fd_.get(), bytes.data() + total, bytes.size() - total, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent <= 0) break;
    total += static_cast<std::size_t>(sent);
  }
  return total;
}

RawClient::Got RawClient::receive(Clock::time_point until) {
  if (!wait(fd_.get(), POLLIN, until)) return Got::Nothing;
  std::array<char, 65536> bytes{};
  const ssize_t size = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
  if (size <= 0) return Got::End;
  received_.append(bytes.data(), static_cast<std::size_t>(size));
  return Got::Bytes;
}

std::optional<Reply> RawClient::reply(std::chrono::milliseconds patience, bool to_head) {
  const auto until = Clock::now() + patient(patience);
  while (true) {
    const auto head_end = received_.find("\r\n\r\n");
    if (head_end != std::string::npos) {
      Reply reply = head_of(std::string_view(received_).substr(0, head_end));
      const std::string_view after = std::string_view(received_).substr(head_end + 4);
      if (reply.headers.contains("transfer-encoding") && !to_head) {
        if (auto chunks = unchunk(after)) {
          reply.body = std::move(chunks->first);
          received_.erase(0, head_end + 4 + chunks->second);
          return reply;
        }
      } else {
        const std::size_t size = to_head ? 0 : number_in(reply.header("content-length"), 10);
        if (after.size() >= size) {
          reply.body = after.substr(0, size);
          received_.erase(0, head_end + 4 + size);
          return reply;
        }
      }
    }
    if (receive(until) != Got::Bytes) return std::nullopt;
  }
}

bool RawClient::wait_for(std::string_view text, std::chrono::milliseconds patience) {
  const auto until = Clock::now() + patient(patience);
  while (received_.find(text) == std::string::npos) {
    if (receive(until) != Got::Bytes) return false;
  }
  received_.erase(0, received_.find(text) + text.size());
  return true;
}

std::optional<std::string> RawClient::rest(std::chrono::milliseconds patience) {
  const auto until = Clock::now() + patient(patience);
  while (true) {
    const Got got = receive(until);
    if (got == Got::End) return std::move(received_);
    if (got == Got::Nothing) return std::nullopt;
  }
}

std::size_t RawClient::read_slowly(std::size_t step, std::size_t size, const std::function<void()>& between) {
  std::string bytes(step, ' ');
  std::size_t total = 0, head = 0;
  while (head == 0 || total < head + size) {
    const ssize_t got =
        ::recv(fd_.get(), bytes.data(), head == 0 ? step : std::min(step, head + size - total),
               head == 0 ? 0 : MSG_WAITALL);
    if (got <= 0) break;
    if (head == 0) head = bytes.find("\r\n\r\n") + 4;
    total += static_cast<std::size_t>(got);
    between();
  }
  return total - std::min(total, head);
}

void RawClient::half_close() {
  ::shutdown(fd_.get(), SHUT_WR);
}

void RawClient::reset() {
  const linger at_once{.l_onoff = 1, .l_linger = 0};
  ::setsockopt(fd_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  fd_ = {};
}

std::string request(std::string_view method, std::string_view path, std::string_view headers,
                    std::string_view body) {
  std::string text;
  text.append(method).append(" ").append(path).append(" HTTP/1.1\r\nHost: adit.local\r\n").append(headers);
  if (!body.empty()) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  text.append("\r\n").append(body);
  return text;
}

}  // namespace adit::intake
