#include "peer.hpp"

#include <gtest/gtest.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "patience.hpp"

namespace adit::uplink {
namespace {

std::size_t length_in(const std::string& head) {
  const std::string_view field = "\r\nContent-Length: ";
  const auto at = head.find(field);
  return at == std::string::npos ? 0 : std::strtoul(head.c_str() + at + field.size(), nullptr, 10);
}

}  // namespace

Wire::Wire(loop::FileDescriptor fd) : fd_(std::move(fd)) {
  const timeval within{patient(std::chrono::seconds{20}).count(), 0};
  ::setsockopt(fd_.get(), SOL_SOCKET, SO_RCVTIMEO, &within, sizeof within);
  ::setsockopt(fd_.get(), SOL_SOCKET, SO_SNDTIMEO, &within, sizeof within);
}

std::size_t Wire::read_some(std::size_t most) {
  std::string bytes(most, '\0');
  const ssize_t got = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
  was_reset_ = got < 0 && errno == ECONNRESET;
  if (got <= 0) return 0;
  unread_.append(bytes, 0, static_cast<std::size_t>(got));
  return static_cast<std::size_t>(got);
}

std::string Wire::read_head() {
  std::size_t end = 0;
  while ((end = unread_.find("\r\n\r\n")) == std::string::npos)
    if (read_some(4096) == 0) return "";
  std::string head = unread_.substr(0, end + 4);
  unread_.erase(0, end + 4);
  return head;
}

std::string Wire::read_request() {
  const std::string head = read_head();
  return read_rest(head);
}

std::string Wire::read_rest(const std::string& head) {
  const std::size_t length = length_in(head);
  while (unread_.size() < length)
    if (read_some(1 << 20) == 0) return "";
  std::string request = head + unread_.substr(0, length);
  unread_.erase(0, length);
  return request;
}

bool Wire::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t taken = ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (taken <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(taken));
  }
  return true;
}

void Wire::wait_for_close() {
  while (read_some(1 << 16) > 0) unread_.clear();
}

void Wire::reset() {
  const linger at_once{1, 0};
  ::setsockopt(fd_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  close();
}

Peer::Peer(std::vector<Script> scripts, const char* address)
    : scripts_(std::move(scripts)), address_(address) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address, "0", &hints, &found) != 0) throw std::runtime_error("bad address");
  listener_ = loop::FileDescriptor(::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!listener_) throw std::runtime_error("the test's peer has no socket");
  hold(256 * 1024);  // small, so that a body soon fills it
  const int bound = ::bind(listener_.get(), found->ai_addr, found->ai_addrlen);
  ::freeaddrinfo(found);
  if (bound != 0) throw std::runtime_error("the test's peer cannot bind");
}

Peer::~Peer() {
  ::shutdown(listener_.get(), SHUT_RDWR);  // ends accept()
  if (thread_.joinable()) thread_.join();
}

void Peer::hold(int bytes) {
  ::setsockopt(listener_.get(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
}

void Peer::listen() {
  if (::listen(listener_.get(), 16) != 0) throw std::runtime_error("the test's peer cannot listen");
  thread_ = std::thread([this] { serve(); });
}

void Peer::serve() {
  while (true) {
    const int fd = ::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC);
    if (fd < 0) return;
    Wire wire{loop::FileDescriptor(fd)};
    if (all_at_once_) {
      threads_.emplace_back([this, wire = std::move(wire)]() mutable { serve(std::move(wire)); });
    } else {
      serve(std::move(wire));
    }
  }
}

void Peer::serve(Wire wire) {
  const auto script = std::min(static_cast<std::size_t>(begun_++), scripts_.size() - 1);
  scripts_[script](wire);
  wire.close();
  ++ended_;
}

Endpoint Peer::endpoint() const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size);
  const auto* ipv4 = reinterpret_cast<const sockaddr_in*>(&address);  // IPv6 has its port at the same place
  Endpoint endpoint;
  endpoint.address = address_;
  endpoint.port = ntohs(ipv4->sin_port);
  return endpoint;
}

std::string answer(std::string_view status, std::string_view body, std::string_view fields) {
  return "HTTP/1.1 " + std::string(status) + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
         std::string(fields) + "\r\n" + std::string(body);
}

std::string without_slash(std::string_view request) {
  const auto between = [&](std::string_view begin, std::string_view end) {
    const auto from = request.find(begin) + begin.size();
    return std::string(request.substr(from, request.find(end, from) - from));
  };
  const std::string target = between(" ", " ");
  if (target.ends_with('/')) return "";
  const std::string there = "http://" + between("Host: ", "\r\n") + target + "/";
  return answer("301 Moved Permanently", "<html>moved</html>", "Location: " + there + "\r\n");
}

Peer::Script always(std::string bytes) {
  return [bytes = std::move(bytes)](Wire& wire) {
    while (!wire.read_request().empty())
      if (!wire.write(bytes)) return;
  };
}

}  // namespace adit::uplink
