#include "uplink/socket.hpp"

#include <gmock/gmock.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "peer.hpp"

namespace adit::uplink {
namespace {

template <class T>
T option(const loop::FileDescriptor& fd, int level, int name) {
  T value{};
  socklen_t size = sizeof value;
  EXPECT_EQ(::getsockopt(fd.get(), level, name, &value, &size), 0);
  return value;
}

loop::FileDescriptor socket_of(const Endpoint& endpoint) {
  auto fd = begin_connect(endpoint);
  EXPECT_TRUE(fd) << fd.error().why;
  return fd ? std::move(*fd) : loop::FileDescriptor();
}

TEST(Socket, SendsAtOnceAndNoticesADeadPeer) {
  const ListeningPeer peer([](Wire& wire) { wire.wait_for_close(); });
  const auto fd = socket_of(peer.endpoint());
  EXPECT_EQ(option<int>(fd, IPPROTO_TCP, TCP_NODELAY), 1);
  EXPECT_EQ(option<int>(fd, SOL_SOCKET, SO_KEEPALIVE), 1);
  EXPECT_EQ(option<int>(fd, IPPROTO_TCP, TCP_KEEPIDLE), 5);
  give_up_after(fd.get(), std::chrono::milliseconds(1234));
  EXPECT_EQ(option<int>(fd, IPPROTO_TCP, TCP_USER_TIMEOUT), 1234);
}

TEST(Socket, SendsLargerBurstsAtAFasterPace) {
  const ListeningPeer peer([](Wire& wire) { wire.wait_for_close(); });
  std::array<char, 20 * 2896> bytes{};
  const iovec piece{bytes.data(), bytes.size()};
  const auto segments = [&](std::uint64_t bytes_per_second) {
    const auto fd = socket_of(peer.endpoint());
    pollfd writable{.fd = fd.get(), .events = POLLOUT, .revents = 0};
    EXPECT_EQ(::poll(&writable, 1, 10'000), 1);
    EXPECT_EQ(write_evenly(fd.get(), {&piece, 1}, bytes_per_second), bytes.size());
    for (int i = 0; i < 10'000 && unacknowledged_bytes(fd.get()) > 0; ++i) ::usleep(1000);
    const auto sent = option<tcp_info>(fd, IPPROTO_TCP, TCP_INFO);
    return sent.tcpi_data_segs_out - sent.tcpi_total_retrans;  // a busy machine acknowledges late
  };
  EXPECT_EQ(segments(11'800'000), 20);
  EXPECT_LE(segments(118'000'000), 5);
  EXPECT_LE(segments(11'800'000'000), 2);
}

TEST(Socket, IsPacedByTheKernelOnRequest) {
  const ListeningPeer peer([](Wire& wire) { wire.wait_for_close(); });
  Endpoint endpoint = peer.endpoint();
  EXPECT_EQ(option<std::uint64_t>(socket_of(endpoint), SOL_SOCKET, SO_MAX_PACING_RATE), ~std::uint64_t{0});
  for (const std::uint64_t pace :
       {std::uint64_t{12'500}, std::uint64_t{5'000'000'000}}) {  // past 32 bits, too
    endpoint.bytes_per_second = pace;
    EXPECT_EQ(option<std::uint64_t>(socket_of(endpoint), SOL_SOCKET, SO_MAX_PACING_RATE), pace);
  }
}

TEST(Socket, BuffersLittleUnsentData) {
  const ListeningPeer peer([](Wire& wire) { wire.wait_for_close(); });
  Endpoint endpoint = peer.endpoint();
  EXPECT_EQ(option<int>(socket_of(endpoint), IPPROTO_TCP, TCP_NOTSENT_LOWAT), 64 * 1024);
  endpoint.bytes_per_second = 11'000'000;
  EXPECT_EQ(option<int>(socket_of(endpoint), IPPROTO_TCP, TCP_NOTSENT_LOWAT), 256 * 1024);
  endpoint.bytes_per_second = 100'000;
  EXPECT_EQ(option<int>(socket_of(endpoint), IPPROTO_TCP, TCP_NOTSENT_LOWAT), 25'000);
}

TEST(Socket, NamesItsPeerAsInHttp) {
  const auto authority = [](const char* address, std::uint16_t port) {
    Endpoint endpoint;
    endpoint.address = address;
    endpoint.port = port;
    return authority_of(endpoint);
  };
  EXPECT_EQ(authority("10.100.1.200", 8000), "10.100.1.200:8000");
  EXPECT_EQ(authority("fd00::1", 80), "[fd00::1]:80");
  EXPECT_EQ(authority("fe80::1%darpa0", 80), "[fe80::1]:80");
}

}  // namespace
}  // namespace adit::uplink
