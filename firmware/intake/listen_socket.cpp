#include "intake/listen_socket.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>

namespace adit::intake {
namespace {

constexpr int kBacklog = 256;
constexpr int kProbes = 3;  // unanswered ones until the kernel gives a silent peer up

using Seconds = std::chrono::seconds;

std::string failed(const std::string& doing) {
  return doing + ": " + std::strerror(errno);
}

bool set(int fd, int level, int option, int value) {
  return ::setsockopt(fd, level, option, &value, sizeof value) == 0;
}

/// Inherited by the accepted sockets (tcp(7)).
void set_keepalive(int fd, std::chrono::milliseconds idle) {
  const auto probe = std::max<Seconds>(std::chrono::duration_cast<Seconds>(idle) / (kProbes + 1), Seconds(1));
  set(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
  set(fd, IPPROTO_TCP, TCP_KEEPIDLE, static_cast<int>(probe.count()));
  set(fd, IPPROTO_TCP, TCP_KEEPINTVL, static_cast<int>(probe.count()));
  set(fd, IPPROTO_TCP, TCP_KEEPCNT, kProbes);
  set(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<int>(idle.count()));
}

}  // namespace

std::expected<loop::FileDescriptor, std::string> open_listen_socket(const Listen& listen) {
  const std::string place = listen.address + " port " + std::to_string(listen.port);
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error =
      ::getaddrinfo(listen.address.c_str(), std::to_string(listen.port).c_str(), &hints, &found);
  if (error != 0) return std::unexpected(listen.address + ": not an IP address: " + ::gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> address(found, &::freeaddrinfo);

  loop::FileDescriptor fd(::socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd) return std::unexpected(failed("opening a socket for " + place));
  set(fd.get(), SOL_SOCKET, SO_REUSEADDR, 1);
  if (address->ai_family == AF_INET6) set(fd.get(), IPPROTO_IPV6, IPV6_V6ONLY, 0);
  if (!listen.interface.empty() &&
      ::setsockopt(fd.get(), SOL_SOCKET, SO_BINDTODEVICE, listen.interface.c_str(),
                   static_cast<socklen_t>(listen.interface.size())) != 0) {
    return std::unexpected(failed("binding to interface " + listen.interface));
  }
  set_keepalive(fd.get(), listen.idle);
  if (::bind(fd.get(), address->ai_addr, address->ai_addrlen) != 0) {
    return std::unexpected(failed("binding to " + place));
  }
  if (::listen(fd.get(), kBacklog) != 0) return std::unexpected(failed("listening on " + place));
  return fd;
}

std::uint16_t port_of(int fd) {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  if (::getsockname(fd, reinterpret_cast<sockaddr*>(&bound), &size) != 0) return 0;
  if (bound.ss_family == AF_INET6) return ntohs(reinterpret_cast<sockaddr_in6*>(&bound)->sin6_port);
  return ntohs(reinterpret_cast<sockaddr_in*>(&bound)->sin_port);
}

std::string local_address(int fd) {
  sockaddr_storage local{};
  socklen_t size = sizeof local;
  if (::getsockname(fd, reinterpret_cast<sockaddr*>(&local), &size) != 0) return "";
  return address_text(reinterpret_cast<const sockaddr*>(&local));
}

std::string address_text(const sockaddr* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address->sa_family == AF_INET) {
    const auto* v4 = reinterpret_cast<const sockaddr_in*>(address);
    ::inet_ntop(AF_INET, &v4->sin_addr, text.data(), text.size());
  } else if (address->sa_family == AF_INET6) {
    const auto* v6 = reinterpret_cast<const sockaddr_in6*>(address);
    if (IN6_IS_ADDR_V4MAPPED(&v6->sin6_addr)) {
      ::inet_ntop(AF_INET, &v6->sin6_addr.s6_addr[12], text.data(), text.size());
    } else {
      ::inet_ntop(AF_INET6, &v6->sin6_addr, text.data(), text.size());
    }
  }
  return text.data();
}

}  // namespace adit::intake
