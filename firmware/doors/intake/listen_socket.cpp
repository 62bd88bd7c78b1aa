#include "intake/listen_socket.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/tcp.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>

namespace adit::intake {
namespace {

/// Clients that connect during a process restart queue here: two seconds at 200 a second, and a reserve.
constexpr int kBacklog = 1024;
constexpr int kProbes = 3;  // unanswered probes before the kernel closes a connection

using Seconds = std::chrono::seconds;

std::string failure_text(const std::string& doing) {
  return doing + ": " + std::strerror(errno);
}

bool set(int fd, int level, int option, int value) {
  return ::setsockopt(fd, level, option, &value, sizeof value) == 0;
}

/// Accepted sockets inherit these options (tcp(7)).
void set_keepalive(int fd, std::chrono::milliseconds idle) {
  const auto probe = std::max<Seconds>(std::chrono::duration_cast<Seconds>(idle) / (kProbes + 1), Seconds(1));
  set(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
  set(fd, IPPROTO_TCP, TCP_KEEPIDLE, static_cast<int>(probe.count()));
  set(fd, IPPROTO_TCP, TCP_KEEPINTVL, static_cast<int>(probe.count()));
  set(fd, IPPROTO_TCP, TCP_KEEPCNT, kProbes);
  set(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<int>(idle.count()));
}

std::optional<int> get(int fd, int option) {
  int value = 0;
  socklen_t size = sizeof value;
  if (::getsockopt(fd, SOL_SOCKET, option, &value, &size) != 0) return std::nullopt;
  return value;
}

bool is_any(const std::string& address) {
  return address == "0.0.0.0" || address == "::";
}

/// The same text for equal IPv6 addresses.
std::string canonical(const std::string& address) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (::inet_pton(AF_INET6, address.c_str(), bytes.data()) != 1) return address;
  ::inet_ntop(AF_INET6, bytes.data(), text.data(), text.size());
  return text.data();
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
  if (!fd) return std::unexpected(failure_text("opening a socket for " + place));
  set(fd.get(), SOL_SOCKET, SO_REUSEADDR, 1);
  if (address->ai_family == AF_INET6) set(fd.get(), IPPROTO_IPV6, IPV6_V6ONLY, 0);
  if (!listen.interface.empty() &&
      ::setsockopt(fd.get(), SOL_SOCKET, SO_BINDTODEVICE, listen.interface.c_str(),
                   static_cast<socklen_t>(listen.interface.size())) != 0) {
    return std::unexpected(failure_text("binding to interface " + listen.interface));
  }
  if (listen.free_bind) {
    const bool v6 = address->ai_family == AF_INET6;
    set(fd.get(), v6 ? IPPROTO_IPV6 : IPPROTO_IP, v6 ? IPV6_FREEBIND : IP_FREEBIND, 1);
  }
  set_keepalive(fd.get(), listen.idle);
  if (::bind(fd.get(), address->ai_addr, address->ai_addrlen) != 0) {
    return std::unexpected(failure_text("binding to " + place));
  }
  if (::listen(fd.get(), kBacklog) != 0) return std::unexpected(failure_text("listening on " + place));
  return fd;
}

std::expected<void, std::string> adopt_listen_socket(int fd, const Listen& listen) {
  const int flags = ::fcntl(fd, F_GETFL);
  if (flags < 0 || ::fcntl(fd, F_SETFL, flags | O_NONBLOCK) != 0) {
    return std::unexpected(failure_text("taking over a socket"));
  }
  set_keepalive(fd, listen.idle);
  if (::listen(fd, kBacklog) != 0) return std::unexpected(failure_text("listening on an inherited socket"));
  return {};
}

std::expected<ListenAddress, std::string> bound_at(int fd) {
  static const std::string kExpected = "expected a listening TCP socket over IPv4 or IPv6, got ";
  const auto type = get(fd, SO_TYPE), domain = get(fd, SO_DOMAIN);
  if (!type) return std::unexpected(kExpected + "no socket");
  if (*domain != AF_INET && *domain != AF_INET6)
    return std::unexpected(kExpected + "a socket of another family");
  if (*type != SOCK_STREAM) return std::unexpected(kExpected + "a socket that is not a stream");
  if (get(fd, SO_ACCEPTCONN) != 1) return std::unexpected(kExpected + "a socket that does not listen");
  std::array<char, IFNAMSIZ> interface{};
  socklen_t size = interface.size();
  if (::getsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, interface.data(), &size) != 0) interface[0] = '\0';
  int only_v6 = 0;
  size = sizeof only_v6;
  if (*domain == AF_INET6) ::getsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &only_v6, &size);
  return ListenAddress{.address = local_address(fd),
                       .port = port_of(fd),
                       .interface = interface.data(),
                       .only_v6 = only_v6 != 0};
}

bool is_orphaned(int fd) {
  std::array<char, IFNAMSIZ> interface{};
  socklen_t size = interface.size();
  return ::getsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, interface.data(), &size) != 0 && errno == ENODEV;
}

bool covers(const ListenAddress& bound, const Listen& listen) {
  if (bound.port != listen.port) return false;
  // A socket that is bound to no interface would also answer on others.
  if (!listen.interface.empty() && bound.interface != listen.interface) return false;
  const bool wants_v6 = listen.address.find(':') != std::string::npos;
  if (bound.address == "::") return wants_v6 || !bound.only_v6;
  if (is_any(bound.address)) return !wants_v6;
  return canonical(bound.address) == canonical(listen.address);
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
