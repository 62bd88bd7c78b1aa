#include "uplink/socket.hpp"

#include <arpa/inet.h>
#include <linux/sockios.h>
#include <linux/tcp.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>

namespace adit::uplink {
namespace {

/// Keep-alive probes find a pulled cable while no request is in flight: after 5 s, then every 2 s.
constexpr int kKeepAliveIdle = 5, kKeepAliveInterval = 2, kKeepAliveProbes = 3;

/// The most unsent bytes that the kernel holds, so that sent_bytes() is close to the truth. The kernel asks
/// for more when half are left.
constexpr std::uint64_t kMostUnsent = 65536;
/// The same for a paced connection, whose bytes queue in the socket and not in the link. When the kernel asks
/// for more, 10 ms are left at 100 Mbit/s, which gives the loop time.
constexpr std::uint64_t kMostUnsentPaced = 256 * 1024;
/// For a paced connection: bytes unsent and in flight.
constexpr int kPacedSendBuffer = 512 * 1024;

/// A burst has at least two full Ethernet segments. MSG_EOR keeps each burst separate. All bursts of one call
/// are at least about 180 kB. Small bursts take 1 ms of CPU time for each MB.
constexpr std::uint64_t kLeastBurst = 2 * 1448, kMostBurst = 65536, kBurstsPerSecond = 5000;
constexpr std::size_t kMostBursts = 64;

/// The kernel's times have the resolution of its tick: 10 ms if CONFIG_HZ is 100.
constexpr std::chrono::milliseconds kTick{10};

struct FreeAddresses {
  void operator()(addrinfo* addresses) const { ::freeaddrinfo(addresses); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

/// Accepts numeric addresses only and never looks up a name. getaddrinfo() parses zones ("fe80::1%darpa0"),
/// but would also read "10.100.1" as 10.100.0.1.
Addresses parse(const Endpoint& endpoint) {
  in_addr ipv4{};
  const bool is_ipv6 = endpoint.address.find(':') != std::string::npos;
  if (!is_ipv6 && ::inet_pton(AF_INET, endpoint.address.c_str(), &ipv4) != 1) return nullptr;
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(endpoint.port);
  if (::getaddrinfo(endpoint.address.c_str(), port.c_str(), &hints, &found) != 0) return nullptr;
  return Addresses(found);
}

template <class T>
int set(int fd, int level, int option, const T& value) {
  return ::setsockopt(fd, level, option, &value, sizeof value) == 0 ? 0 : errno;
}

/// A quarter of a second of a slow pace, so that progress is seen often enough to tell slow from silent.
int most_unsent(std::uint64_t bytes_per_second) {
  if (bytes_per_second == 0) return static_cast<int>(kMostUnsent);
  return static_cast<int>(std::clamp<std::uint64_t>(bytes_per_second / 4, 4096, kMostUnsentPaced));
}

/// 0 or an errno.
int set_most(int fd, std::uint64_t bytes_per_second) {
  // The kernel reads an unsigned long. All ones would mean no pace.
  const auto rate = static_cast<unsigned long>(
      std::min<std::uint64_t>(bytes_per_second, std::numeric_limits<unsigned long>::max() - 1));
  return set(fd, SOL_SOCKET, SO_MAX_PACING_RATE, rate);
}

/// 0 or an errno. Errors of options that only improve the pace are ignored.
int begin_pace(int fd, std::uint64_t bytes_per_second) {
  set(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, most_unsent(bytes_per_second));
  if (bytes_per_second == 0) return 0;
  set(fd, SOL_SOCKET, SO_SNDBUF, kPacedSendBuffer);
  return set_most(fd, bytes_per_second);
}

void keep_alive(int fd) {
  set(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
  set(fd, IPPROTO_TCP, TCP_KEEPIDLE, kKeepAliveIdle);
  set(fd, IPPROTO_TCP, TCP_KEEPINTVL, kKeepAliveInterval);
  set(fd, IPPROTO_TCP, TCP_KEEPCNT, kKeepAliveProbes);
}

std::unexpected<NoSocket> failure(const std::string& doing, int error) {
  return std::unexpected(NoSocket{doing + std::strerror(error), error});
}

}  // namespace

std::expected<loop::FileDescriptor, NoSocket> begin_connect(const Endpoint& endpoint) {
  const Addresses address = parse(endpoint);
  if (!address) return std::unexpected(NoSocket{"\"" + endpoint.address + "\" is not an IP address"});
  loop::FileDescriptor fd(
      ::socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, IPPROTO_TCP));
  if (!fd) return failure("making a socket: ", errno);
  const std::string& interface = endpoint.interface;
  if (!interface.empty() && ::setsockopt(fd.get(), SOL_SOCKET, SO_BINDTODEVICE, interface.data(),
                                         static_cast<socklen_t>(interface.size())) != 0)
    return failure("binding to interface " + interface + ": ", errno);
  if (const int error = begin_pace(fd.get(), endpoint.bytes_per_second); error != 0)
    return failure("setting the pace: ", error);
  set(fd.get(), IPPROTO_TCP, TCP_NODELAY, 1);
  keep_alive(fd.get());
  const int result = ::connect(fd.get(), address->ai_addr, address->ai_addrlen);
  if (result != 0 && errno != EINPROGRESS) return failure("", errno);
  return fd;
}

std::expected<std::size_t, int> write(int fd, std::span<const iovec> pieces) {
  msghdr message{};
  message.msg_iov = const_cast<iovec*>(pieces.data());
  message.msg_iovlen = pieces.size();
  const ssize_t taken = ::sendmsg(fd, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (taken >= 0) return static_cast<std::size_t>(taken);
  return std::unexpected(errno);
}

std::expected<std::size_t, int> write_evenly(int fd, std::span<const iovec> pieces,
                                             std::uint64_t bytes_per_second) {
  const std::size_t burst = std::clamp(bytes_per_second / kBurstsPerSecond, kLeastBurst, kMostBurst);
  std::array<iovec, kMostBursts> parts{};
  std::array<mmsghdr, kMostBursts> messages{};
  unsigned count = 0;
  for (const iovec& piece : pieces) {
    for (std::size_t from = 0; from < piece.iov_len && count < kMostBursts; from += burst, ++count) {
      parts[count] = {.iov_base = static_cast<char*>(piece.iov_base) + from,
                      .iov_len = std::min(burst, piece.iov_len - from)};
      messages[count].msg_hdr.msg_iov = &parts[count];
      messages[count].msg_hdr.msg_iovlen = 1;
    }
  }
  const int taken = ::sendmmsg(fd, messages.data(), count, MSG_NOSIGNAL | MSG_DONTWAIT | MSG_EOR);
  if (taken < 0) return std::unexpected(errno);
  std::size_t bytes = 0;
  for (int i = 0; i < taken; ++i) bytes += messages[i].msg_len;
  return bytes;
}

std::expected<std::size_t, int> read(int fd, std::span<char> bytes) {
  const ssize_t got = ::recv(fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got >= 0) return static_cast<std::size_t>(got);
  return std::unexpected(errno);
}

int connect_error(int fd) {
  int error = 0;
  socklen_t size = sizeof error;
  return ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

void give_up_after(int fd, std::chrono::milliseconds silence) {
  set(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<unsigned>(silence.count()));
}

void reset_on_close(int fd, bool reset) {
  set(fd, SOL_SOCKET, SO_LINGER, linger{.l_onoff = reset ? 1 : 0, .l_linger = 0});
}

bool is_quiet(int fd) {
  char byte = 0;
  return ::recv(fd, &byte, 1, MSG_PEEK | MSG_DONTWAIT) < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
}

Transmission transmission(int fd) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
  const std::chrono::milliseconds since(info.tcpi_last_data_sent);
  return {.since_last_byte = std::max(since - kTick, std::chrono::milliseconds{0}),
          .sent_twice = info.tcpi_total_retrans,
          .delivered = std::uint64_t{info.tcpi_delivered} * info.tcpi_snd_mss,
          .unsent = info.tcpi_notsent_bytes,
          .in_flight = std::size_t{info.tcpi_unacked} * info.tcpi_snd_mss,
          .round_trip = std::chrono::microseconds(info.tcpi_rtt),
          .least_round_trip = std::chrono::microseconds(info.tcpi_min_rtt)};
}

void set_pace(int fd, std::uint64_t bytes_per_second) {
  set_most(fd, bytes_per_second);
}

std::size_t unacknowledged_bytes(int fd) {
  int bytes = 0;
  if (::ioctl(fd, SIOCOUTQ, &bytes) != 0) return std::numeric_limits<std::size_t>::max();
  return static_cast<std::size_t>(std::max(bytes, 0));
}

}  // namespace adit::uplink
